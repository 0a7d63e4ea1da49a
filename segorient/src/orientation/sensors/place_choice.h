// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "orientation/sensors/hiding_place.h"
#include "orientation/sensors/point_hints.h"

namespace segorient::detail {

/// Where a cloud was seen from, as far as that is worth following.
struct PlaceChoice {
  /// What is followed in the place of what was given; none = that as it is.
  std::optional<OrientationHints> hints;
  CloudPlace place;                       ///< the one that is followed
  std::vector<std::uint8_t> either_side;  ///< as PointHints has it
  /// Of what was seen from within a room, as far as shadows tell, unless it is a body: what is
  /// followed then, see boundBodies().
  std::optional<CloudPlace> if_no_room;
  /// Of a search that nobody's knowledge made needless.
  SensorReport sensors;
  std::optional<KnownSensor> refused;  ///< a place that others were found instead of
  /// A place that is not followed, as surfaces go on behind what would hide them from there.
  std::optional<HidingPlace> hiding;
};

/// What the caller knows, and where nothing is known of sensors, what can be found. One place for
/// all points may be a guess of whoever gives it: unless shadows confirm it, sensors that densities
/// tell for sure are followed, if they are not in that place, too.
/// \param points the rows that `given` is about, or an even part of a larger cloud
/// \param cloud made from them
SEGORIENT_ORIENTATION_EXPORT PlaceChoice choosePlaces(const PointView& points,
                                                      const OrientationHints& given,
                                                      bool find_sensors, PreparedCloud& cloud,
                                                      int threads);

}  // namespace segorient::detail
