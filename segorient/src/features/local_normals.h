// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/features/normal_options.h>

#include <vector>

namespace segorient {

/// Estimates one unoriented normal a row of `neighborhoods`.
///
/// Computes with offsets from the point, so a cloud far from the origin loses nothing but what its
/// own rounding has lost already. The curvature is lambda0 / (lambda0 + lambda1 + lambda2) of the
/// plane fit for every estimator, as in PCL. Duplicates of the point count for the plane and are
/// ignored elsewhere. NaN, curvature included, where the neighbourhood has no plane: fewer than
/// three points, all in one place or in a line as far as their rounding tells. LCT and LDT use the
/// neighbours' plane as projection plane, AwAS that of its first guess.
///
/// \param queries row i is the point that row i of the table belongs to
/// \param points what the table's indices refer to; often the same as `queries`
/// \param normals 4 floats a row: nx, ny, nz, curvature
/// \param curvatures one a row or null; needs AwAS, other estimators give NaN
/// \param rows rows to do, or null for all; others are left as they are
SEGORIENT_FEATURES_EXPORT void estimateNormals(const PointView& queries, const PointView& points,
                                               const Neighborhoods& neighborhoods,
                                               const LocalNormalOptions& options, float* normals,
                                               LocalCurvature* curvatures = nullptr,
                                               const std::vector<pcl::index_t>* rows = nullptr);

/// The same for points that are their own queries.
inline void estimateNormals(const PointView& points, const Neighborhoods& neighborhoods,
                            const LocalNormalOptions& options, float* normals) {
  estimateNormals(points, points, neighborhoods, options, normals);
}

}  // namespace segorient
