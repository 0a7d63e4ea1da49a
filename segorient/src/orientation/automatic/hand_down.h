// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>

#include <vector>

#include "orientation/automatic/coarse_levels.h"

namespace segorient::detail {

/// What a level says about all points.
struct Handed {
  AutoNormals found;  ///< the points' own lines, with the level's signs
  /// 4 floats a point: the mean of the level's normals around as a unit vector, and its length,
  /// which is the cosine of their spread; 0 where nothing was heard.
  std::vector<float> around;
};

/// Gives each point the sign of the points of the level that are near.
/// \param level oriented; what it knows of its orientation is moved out
/// \param radius of its subset, in the unit of the points
/// \param fine the points' own normals
SEGORIENT_ORIENTATION_EXPORT Handed handDown(const PointView& points, CoarseLevel& level,
                                             float radius, int threads, const AutoNormals& fine);

}  // namespace segorient::detail
