// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/sensors/point_hints.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Up to this KnownSensor::density the sensor was there: elsewhere it is .7 and more.
constexpr float kConfirmed = 0.7F;
/// With fewer points hidden, by KnownSensor::hidden, a place could have seen all of them.
constexpr float kFewHidden = 0.02F;
/// Share of the pairs of neighbours on one sheet that sensors see from two sides: true ones leave
/// .01, others mostly .05 and more, on the scans of 39 virtual and real clouds.
constexpr float kMostContrary = 0.01F;

/// Whether one of the sensors is not followed as it sees sheets from both sides. Of sensors that
/// were found together, the places, and with that one the others, then explain densities by chance
/// only.
inline bool seeBothSides(const std::vector<KnownSensor>& sensors) {
  return std::any_of(sensors.begin(), sensors.end(),
                     [](const KnownSensor& s) { return !s.used && s.contrary > kMostContrary; });
}

/// Points and the sensors that saw them; both empty where no sensor is known, `sensor_of` also
/// where only directions are.
struct SeenPoints {
  std::vector<std::int32_t> sensor_of;  ///< by point, -1 = none known
  /// 3 floats a point: unit vector to that sensor, 0 where none is known or believed
  std::vector<float> toward;
};

/// Where each point was seen from, as far as that is known and not contradicted.
struct KnownSensors : SeenPoints {
  std::vector<KnownSensor> scans;  ///< `sensor_of` is into these; positions in the cloud's unit
  /// The one place for all points, which a closed surface may contradict as a whole; else every
  /// point has been told its own.
  bool common = false;
  /// All points have been told the same place, whether as theirs or as the common one.
  bool one_place = false;
  /// Of that place: the density of the points shows that it saw them, or where surfaces end does
  /// and few points are hidden.
  bool confirmed = false;
  /// Of that place: there is evidence that it did not see all points, or too little to tell.
  bool doubtful = false;
  /// Of that place: too many points lie behind others.
  bool hides = false;
  /// Of that place: steps of depth say that it may have seen them.
  bool allowed = false;
  /// Of that place: what is around it has openings, as no solid has.
  bool in_a_room = false;
  /// Of that place: there is something all around it, and nothing hidden, as in a solid.
  bool enclosed = false;

  bool none() const { return toward.empty(); }
  const float* of(std::size_t point) const { return &toward[3 * point]; }
  /// Takes back what scans that are not used say of their points.
  void dropUnused();
  /// Counts again how many points each scan has a say about.
  void countSeen();
};

/// Who saw what, checked.
///
/// Scans are points with one sensor. A scan is not followed if its points contradict its sensor
/// (shadows deny it, a place beside it explains their density far better, or some lie behind others
/// or a smooth sheet would have to face both ways, unless their density confirms that it was
/// there, or where surfaces end allows it). Where some are not, poses may have been mixed up:
/// unless most points are of scans that are confirmed, as KnownSensor has it, others are not
/// followed either if nothing speaks for them.
///
/// PointHints::toward is taken as it is; of what faces up, points that nothing is above are towards
/// +z, see openToTheSky().
/// \param spacing one a point: mean distance to the 6 nearest
KnownSensors findKnownSensors(const PointView& points, const Neighborhoods& neighborhoods,
                              const float* spacing, const PointHints& hints, int threads);

/// seeBothSides() of what findKnownSensors() finds. \param[in,out] cloud finds its neighbours
SEGORIENT_ORIENTATION_EXPORT bool seeBothSides(PreparedCloud& cloud, const PointHints& hints,
                                               int threads);

}  // namespace segorient::detail
