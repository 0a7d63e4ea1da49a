// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/features/normal_options.h>

#include <functional>
#include <vector>

namespace segorient {

/// Where neighbours come from: so many nearest (the point itself counts, as in PCL) or all within a
/// radius. One of the two is 0.
struct NeighborhoodSize {
  int k = 0;
  double radius = 0.0;
};

/// Any neighbour search, of point `index` of the input: fills indices into the surface and squared
/// distances and returns how many there are. Called by several threads at once.
using NeighborSearch = std::function<int(pcl::index_t index, pcl::Indices& indices,
                                         std::vector<float>& sqr_distances)>;

/// Finds neighbours with MedianHashIndex and estimates the normals of some points.
///
/// Exact duplicates in the surface are one point, so they cannot fill a neighbourhood.
/// \param input the points; \param indices those to do. Out of range ones get NaN
/// \param surface where neighbours are looked for, or null: in the input
/// \param normals 4 floats an index, see estimateNormals(); \param curvatures one an index or null
SEGORIENT_FEATURES_EXPORT void searchAndEstimateNormals(const PointView& input,
                                                        const pcl::Indices& indices,
                                                        const PointView* surface,
                                                        const NeighborhoodSize& size,
                                                        const LocalNormalOptions& options,
                                                        float* normals, LocalCurvature* curvatures);

/// The same with the neighbours that `search` finds.
SEGORIENT_FEATURES_EXPORT void searchAndEstimateNormals(const PointView& input,
                                                        const pcl::Indices& indices,
                                                        const PointView& surface,
                                                        const NeighborSearch& search,
                                                        const LocalNormalOptions& options,
                                                        float* normals, LocalCurvature* curvatures);

/// The same with a ready table of neighbours, whose rows belong to the points of the input or, if
/// there are not as many, to the indices. \return false if the table has neither as many rows as
/// there are indices nor as there are points,
///         or refers to points that the surface does not have
SEGORIENT_FEATURES_EXPORT bool estimateNormalsFromTable(const PointView& input,
                                                        const pcl::Indices& indices,
                                                        const PointView& surface,
                                                        const Neighborhoods& neighborhoods,
                                                        const LocalNormalOptions& options,
                                                        float* normals, LocalCurvature* curvatures);

}  // namespace segorient
