// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/common/impl/cloud_access.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace segorient {

/// What became of one place that points are said to have been seen from. Places with few points
/// each, as a moving sensor has them, are one entry together, with their mean as its position.
struct KnownSensor {
  std::array<float, 3> position{0.F, 0.F, 0.F};  ///< in input coordinates
  std::size_t points = 0;                        ///< distinct points that are said to be its own
  std::size_t seen = 0;  ///< of these, those that it could see: others were left to the surface
  /// False: the surface or the density contradicts it, and nothing was turned to it. A place behind
  /// whose shadows surfaces go on turns nothing anyway; of it this says whether the result suits
  /// it.
  bool used = true;
  bool moving = false;  ///< many places together
  /// Its density shows that it was there, or what it sees is seen from the same side by others of
  /// which that is shown, and so on.
  bool confirmed = false;
  /// The scan that its points are of, as OrientationHints::scans numbers them; -1 = unknown, or of
  /// several.
  std::int32_t scan = -1;
  /// Share of its points that lie behind others of its own, as seen from there. A sensor sees no
  /// such points: noise and stray points make up to .09 of them. 0 where what hides them is
  /// scattered, as leaves are: beams pass between those.
  float hidden = 0.F;
  /// Share of neighbours on one smooth sheet, its own and others', that would have to face apart.
  float contrary = 0.F;
  /// How far the density of its points falls with distance and incidence as it does from a sensor:
  /// scatter about that law over scatter about a constant. Below .7 it was there; from .9 on it was
  /// not, or the cloud was thinned, or the sensor works otherwise, as from the air (up to 1.6).
  /// Infinity where it could not be told.
  float density = std::numeric_limits<float>::infinity();
};

enum class SensorKind : std::uint8_t {
  STATION,  ///< a scanner that stood still and looked all around
  CAMERA,   ///< a depth camera: one view along an optical axis
  MOVING,   ///< a place on the way of a scanner that went along while it turned
  ABOVE     ///< an aircraft or a drone: far above, `axis` points there
};

/// "station", "camera", "moving" or "above".
SEGORIENT_ORIENTATION_EXPORT const char* toString(SensorKind kind);

/// What told that there was a sensor.
enum class SensorEvidence : std::uint8_t {
  DENSITY,  ///< how the density of points falls with distance and incidence
  LAYERS,   ///< one uneven surface over the ground, as it is seen from above
  IMAGE,    ///< the pixels of an organised cloud: straight rays that meet in one place
  SHADOWS,  ///< surfaces end where something nearer hides them, as seen from a suggested place
  WOODS     ///< one surface over the ground, and all else is scattered above it
};

struct FoundSensor {
  SensorKind kind = SensorKind::STATION;
  SensorEvidence evidence = SensorEvidence::DENSITY;
  std::array<float, 3> position{0.F, 0.F, 0.F};  ///< input coordinates
  /// Unit vector: the optical axis of a camera, into the scene; the axis that a station turned
  /// about, or 0 where none was found; towards what is above.
  std::array<float, 3> axis{0.F, 0.F, 0.F};
  bool suggested = false;  ///< whether the position is one of SensorOptions::suggestions
  std::size_t points = 0;  ///< rows that it explains
  /// What the sensor leaves unexplained of the densities' (or the pixels') deviation from a
  /// constant: 1 = no better than no sensor at all, 0 = everything is explained. From above: the
  /// share of the ground with a second layer. By shadows: share of what ought to be hidden where
  /// depth steps.
  float cost_ratio = 1.F;
  /// Whether normals may be turned to it. Ratios of solids, sheets and clouds without a sensor do
  /// not come near those that count as sure.
  bool sure = false;
};

/// "density", "layers", "image", "shadows" or "woods".
SEGORIENT_ORIENTATION_EXPORT const char* toString(SensorEvidence evidence);

// As they were first called.
[[deprecated("toString")]] inline const char* sensorKindName(SensorKind kind) {
  return toString(kind);
}
[[deprecated("toString")]] inline const char* sensorEvidenceName(SensorEvidence evidence) {
  return toString(evidence);
}

struct SensorOptions {
  /// Positions to be looked at first: where a file says nothing, the origin is where most cameras
  /// and scanners put themselves. A position that fits is preferred to those that are searched,
  /// unless one of them explains far more, or more from the other side of the surface; one that
  /// does not fit is no evidence of anything. Not finite: left out.
  std::vector<std::array<float, 3>> suggestions{{0.F, 0.F, 0.F}};
  bool search = true;  ///< otherwise only suggestions, and images
  /// Pixels in a row of an organised cloud, row by row from the first; 0 = not organised.
  std::size_t image_width = 0;
  int threads = 0;  ///< 0 = all cores; the result does not depend on it
};

struct SensorReport {
  std::vector<FoundSensor> sensors;     ///< by descending number of points
  std::vector<std::int32_t> sensor_of;  ///< for each row, into `sensors`; -1 = by none
  /// Of several sensors: 1 for each row that ones on either side of its surface may have seen, as
  /// far as densities tell. No normal is turned by such a row's. Empty = none.
  std::vector<std::uint8_t> either_side;
  /// Where no sensor was found, but it is known that the scene was seen from within: 3 floats a
  /// row, the mean direction to where it was seen from; 0 = unknown. Empty elsewhere.
  std::vector<float> directions;
  /// Where no sensor was found: it is one surface over the ground, of which the upper side faces
  /// whoever saw it from outside.
  bool faces_up = false;
  /// Mean deviation of log density from a constant, and what it were by chance alone.
  float deviation = 0.F;
  float chance = 0.F;
  std::string why;  ///< in a few words, what was found or why nothing

  /// Whether a sensor was found that normals may be turned to.
  SEGORIENT_ORIENTATION_EXPORT bool sure() const;
};

/// Where the sensors stood, from positions alone.
///
/// Rays that spread by equal angles leave a density of |cos(incidence)| / distance^2 on surfaces,
/// times what the device does to directions: 1 / cos(elevation) for a scanner that turns about an
/// axis, 1 / cos^3 for a camera. The place whose law leaves least of the measured densities is
/// sought; it is a sensor where next to nothing is left. Clouds of even density have none. Some
/// thousand neighbourhoods are looked at, so it takes a fraction of a second on any cloud.
///
/// \param points rows that are not finite and repeated ones take no part
/// \return no sensors where nothing tells (too few points, no flat neighbourhoods, even density)
SEGORIENT_ORIENTATION_EXPORT SensorReport findSensors(const PointView& points,
                                                      const SensorOptions& options = {});

/// The same for a PCL cloud; one that is organised is taken for an image.
template <typename PointT>
SensorReport findSensors(const pcl::PointCloud<PointT>& cloud, SensorOptions options = {}) {
  if (cloud.height > 1 && options.image_width == 0) options.image_width = cloud.width;
  const CloudPoints<PointT> points(cloud);
  return findSensors(points.view(), options);
}

}  // namespace segorient
