// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// What kind of surface a cloud is said to be.
enum class SurfaceKind : std::uint8_t {
  UNKNOWN,  ///< told from the cloud itself
  CLOSED,   ///< each part has an inside; one viewpoint for all does not overrule it
  OPEN      ///< one viewpoint for all decides, whatever looks like an inside
};

/// A range image in a cloud: so many consecutive rows, row by row of the image. Points that the
/// sensor did not see are rows of NaN.
struct OrganizedGrid {
  std::size_t first = 0;  ///< input row of the first pixel
  std::size_t width = 0;
  std::size_t height = 0;
};

/// What is known about the orientation of a cloud beforehand, for OrientationMethod::AUTO.
///
/// Where a point was seen from is a fact: its normal faces that place, and the surface around it
/// decides only where the view is so grazing that the normal's own error could turn it, and where
/// nothing is known. Scans that contradict their sensor, as a wrong pose makes them, are reported
/// (KnownSensor), and so are those that nothing confirms if sensors are found elsewhere. For their
/// points, and for others without a place, sensors that are found tell, or else the surface. One
/// viewpoint for all points does not count for what closes in itself, unless the density of the
/// points shows that they were seen from there, or `surface` is OPEN; and for none where surfaces
/// go on behind what would hide them from it.
///
/// Seeds and normals are evidence: seeds weigh most. Each turns over connected components, and
/// clusters of segments that borders do not hold firmly.
struct OrientationHints {
  /// A point and the normal that its surface has there, of any length.
  struct Seed {
    std::array<float, 3> position{0.F, 0.F, 0.F};
    std::array<float, 3> normal{0.F, 0.F, 0.F};
  };

  SurfaceKind surface = SurfaceKind::UNKNOWN;
  bool has_viewpoint = false;                     ///< whether `viewpoint` is given
  std::array<float, 3> viewpoint{0.F, 0.F, 0.F};  ///< where all points were seen from
  /// Where each point was seen from: 3 floats an input row, NaN = unknown. Rows beyond the end of
  /// the vector are unknown.
  std::vector<float> viewpoints;
  /// Whether `direction` is given: a sensor so far away that all of its rays are parallel, such as
  /// an aircraft. Points whose own place in `viewpoints` is known keep that; a `viewpoint` that is
  /// given as well comes second to it.
  bool has_direction = false;
  std::array<float, 3> direction{0.F, 0.F, 1.F};  ///< towards that sensor, of any length but 0
  /// Which scan (one standpoint, one sweep, one file) each input row is of; below 0, and beyond the
  /// end of the vector: unknown. It says nothing about sides by itself; it tells which points one
  /// wrong pose would spoil together.
  std::vector<std::int32_t> scans;
  /// The range images among the rows, in order, not overlapping. A grid is seen from one place, and
  /// its neighbours are neighbours in the sensor's view.
  std::vector<OrganizedGrid> grids;
  /// Normals whose signs say something: 3 floats an input row, NaN or 0 = none; as `viewpoints`.
  std::vector<float> normals;
  /// Each counts for the point nearest to it; none: NaN, zero, and what is farther from the cloud
  /// than that is wide, as it must be in other coordinates (PipelineReport::seeds_left_out).
  std::vector<Seed> seeds;
  /// Where a sensor may have stood; tried where none is known, see SensorOptions::suggestions.
  std::vector<std::array<float, 3>> suggested{{0.F, 0.F, 0.F}};
};

}  // namespace segorient
