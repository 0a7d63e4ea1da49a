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
  CLOSED,   ///< each part has an inside; a viewpoint does not overrule it
  OPEN      ///< a viewpoint decides, whatever looks like an inside
};

/// What is known about the orientation of a cloud beforehand: evidence for OrientationMethod::AUTO,
/// not truth. Seeds weigh most, then what is said of each point, then the viewpoint, which only
/// open surfaces listen to: nothing closed is seen whole from one place. Each turns over connected
/// components, and clusters of segments that borders do not hold firmly.
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
