// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <vector>

#include "orientation/filtered_normals.h"

namespace segorient {

/// Confidence where the normals around agree to some degrees: another round would change nothing.
constexpr float kAllAgree = 0.999F;

/// Final normals from the oriented normals around each point, that of the point itself being one of
/// them.
///
/// A bilateral mean: every neighbour offers its tangent plane, and counts by how near the point is
/// to that plane, by how well the plane fitted, and by how near the neighbour is. At an edge only
/// the planes of the point's own face pass near it, on a thin wall only those of its own side;
/// where the noise leaves two faces possible, the mean stands between them. A point without a
/// normal, or with a wrong sign among right ones, gets that of its surroundings.
///
/// In a narrow wedge, where that mean could point to either side, a point takes the normal of the
/// face it lies on, and small patches that a segment took from the other face are turned over.
///
/// \param oriented 4 floats a point: oriented normal, rms residual in spacings
/// \param spacing one a point
/// \param residual median residual of the cloud, in spacings
/// \param wedges what is said of wedges; without noise of more than about a tenth of a spacing
FilteredNormals filterOrientedNormals(const PointView& points, const Neighborhoods& neighborhoods,
                                      std::vector<float> oriented,
                                      const std::vector<float>& spacing, float residual,
                                      int rounds = 2, bool wedges = true, int threads = 0);

}  // namespace segorient
