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

/// What is known about the orientation of a cloud beforehand, for OrientationMethod::AUTO.
///
/// Where a point was seen from is a fact: its normal faces that place, and the surface around it
/// decides only where the view is so grazing that the normal's own error could turn it, and where
/// nothing is known. Points that contradict their sensor, as a wrong pose makes them, are left to
/// the surface and reported (SensorReport). One viewpoint for all points counts for those that it
/// could have seen, and not for what closes in itself, unless the density of the points shows that
/// they were seen from there, or `surface` is OPEN.
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
  /// Normals whose signs say something: 3 floats an input row, NaN or 0 = none; as `viewpoints`.
  std::vector<float> normals;
  std::vector<Seed> seeds;  ///< each counts for the point nearest to it; NaN or zero: none
};

}  // namespace segorient
