// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstddef>
#include <vector>

#include "orientation/filtered_normals.h"

namespace segorient {

/// Confidence from which on there is nothing to mend.
constexpr float kNothingToMend = 0.97F;

/// Normals from the winding-number field, where noise leaves several possible.
///
/// Planes that were fitted to noisy points near an edge mix its two faces, and whichever of their
/// normals a point there takes, it may be that of the other face, which is a wrong one if the edge
/// is acute. The field of all oriented points changes from one face to the other without a jump:
/// where it falls fastest lies between the two, and mostly less than a right angle from either.
/// Normals are tilted, never turned over.
///
/// This is the step of WNNC (Lin, Shi and Liu 2024, "Fast and globally consistent normal
/// orientation based on the winding number normal consistency"), taken once, from normals that are
/// oriented already, and only for points whose surroundings do not agree. Without noise of about a
/// tenth of a spacing nothing is changed: edges are known better then. O(log n) for each of those
/// points; about 30 bytes a point while it runs.
///
/// \param points finite, near ones side by side (CompactCloud's order)
/// \param spacing one a point
/// \param residual median residual of the cloud, in spacings
/// \param everywhere whether the normals around are no sign of being right, see SheetTraits
/// \param threads 0 = all cores
/// \param filtered as filterOrientedNormals() returns it; confidences, residuals and missing
///        normals stay as they are
/// \return how many points have a new normal; 0 also where the sizes of the arrays do not match
std::size_t refineByWinding(const PointView& points, const std::vector<float>& spacing,
                            float residual, bool everywhere, int threads,
                            FilteredNormals& filtered);

}  // namespace segorient
