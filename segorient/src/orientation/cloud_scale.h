// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

namespace segorient {

/// Spacing and noise of a cloud, from a sample of its points.
struct CloudScale {
  float spacing = 0.F;  ///< median of the mean distance to the 6 nearest
  float noise = 0.F;  ///< median of the rms distance of 18 neighbours from their plane, in spacings
};

/// \param index built on all of `points`
CloudScale measureScale(const PointView& points, const search::MedianHashIndex& index);

/// How many neighbours normals and segments should rest on at that noise: few on clean clouds,
/// where more would round off the edges; many where a few would not see the surface for the noise.
int neighborsForNoise(float noise);

}  // namespace segorient
