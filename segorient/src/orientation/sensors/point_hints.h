// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/orientation/orientation_hints.h>

#include <array>
#include <cstddef>
#include <vector>

#include "orientation/sensors/shadows.h"
#include "search/prepared_cloud.h"

namespace segorient {

/// OrientationHints by distinct point, in the unit of a PreparedCloud.
struct PointHints {
  struct Seed {
    std::size_t point = 0;
    std::array<float, 3> normal{0.F, 0.F, 0.F};  ///< unit length
  };

  SurfaceKind surface = SurfaceKind::UNKNOWN;
  bool has_viewpoint = false;
  std::array<float, 3> viewpoint{0.F, 0.F, 0.F};
  /// Whether a search for sensors came to the one place for all points, too, by itself, or found it
  /// by layers, which is told about trees already.
  bool place_found = false;
  /// Whether all of it is one surface over the ground, see SensorReport.
  bool faces_up = false;
  /// What steps of depth say of that place; no steps where nobody looked.
  detail::Shadows shadows;
  /// 3 floats a point: where it was seen from, NaN = unknown; empty = none
  std::vector<float> sensors;
  /// 3 floats a point: sum of the unit vectors that its normal is said to point along; empty = none
  std::vector<float> directions;
  std::vector<Seed> seeds;
  /// 3 floats a point: unit vector to the sensor that saw it, 0 = unknown; empty unless it is
  /// already known which sensors are to be believed. Then `sensors` is empty.
  std::vector<float> toward;

  /// Whether there is nothing that knows sides better than the points themselves.
  bool nothing() const {
    return surface != SurfaceKind::OPEN && !has_viewpoint && !faces_up && sensors.empty() &&
           directions.empty() && seeds.empty() && toward.empty();
  }
};

/// \param cloud the one that `hints` is about
SEGORIENT_ORIENTATION_EXPORT PointHints resolveHints(const OrientationHints& hints,
                                                     PreparedCloud& cloud);

}  // namespace segorient
