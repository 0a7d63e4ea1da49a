// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <vector>

namespace segorient {

/// Normals and how much the field agrees with them.
struct ConsistentNormals {
  std::vector<float> normals;  ///< 4 floats a point: unit, 0 where the field does not fall
  /// One a point: how the field that the first radius makes of them falls along them, 1 = as that
  /// of a plane; less where others are near that contradict it, below 0 where they outweigh it.
  std::vector<float> steepness;
};

/// Radii that dipoles are smeared over, in the points' unit.
struct ShrinkingRadius {
  float first;  ///< wide, so that the body shows as a whole
  float last;
};

/// Oriented normals from positions alone: those along which the winding number of their own dipoles
/// falls (WNNC; Lin, Shi and Liu 2024, "Fast and globally consistent normal orientation based on
/// the winding number normal consistency").
///
/// Steps of steepest descent to w = 1/2 at all points, from no dipoles at all; after each of them
/// every dipole is turned the way that w falls there. For closed surfaces: of open ones one part
/// may come out as the back of another. Some 160 evaluations of a field, each O(n log n).
///
/// \param points finite, near ones side by side \param areas one a point
/// \param threads see resolveThreads(); the result does not depend on it
ConsistentNormals consistentNormals(const PointView& points, const std::vector<float>& areas,
                                    const ShrinkingRadius& radius, int threads);

}  // namespace segorient
