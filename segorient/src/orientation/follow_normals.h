// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/segmentation/segmentation.h>

namespace segorient {
namespace detail {
struct AutoStages;
}

/// Gives a segmentation signs for normals that it was not made from. Points without a normal leave
/// their segment.
void giveSigns(const PointView& normals, Segmentation& segmentation);

/// Orients normals that are there by those that the default method found: each point takes the sign
/// that turns its normal to the found one, a point where none was found that of its surroundings,
/// and a segment that of most of its points.
/// \param normals 4 floats a row; the sign of each is arbitrary
/// \param segmentation of these points and normals
/// \param turn_outward false: the largest segment of each component keeps its sign
OrientationResult followNormals(const PointView& points, const PointView& normals,
                                const Neighborhoods& neighborhoods,
                                const Segmentation& segmentation, bool turn_outward,
                                const detail::AutoStages& found);

}  // namespace segorient
