// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/segmentation/segmentation.h>

namespace segorient {

/// Orients a segmented cloud by one of the paper's methods or HOPPE: segments first, every other
/// point that has a normal from what surrounds it, and every connected component outward (paper,
/// section 3). For AUTO see followNormals().
///
/// \param normals 4 floats a row; the sign of each is arbitrary
/// \param neighborhoods of every point
OrientationResult orientSegments(const PointView& points, const PointView& normals,
                                 const Neighborhoods& neighborhoods,
                                 const Segmentation& segmentation,
                                 const OrientationOptions& options);

/// Results of those segments that have none: the sign that most of a segment's points have.
/// \param by what decided these
void summarizeSegments(const Segmentation& segmentation, DecidedBy by, OrientationResult& result);

}  // namespace segorient
