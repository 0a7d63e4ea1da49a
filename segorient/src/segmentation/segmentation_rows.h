// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <vector>

#include "search/prepared_cloud.h"
#include "segmentation/region_growing.h"

namespace segorient::segmentation {

/// Fills in members, and each segment's place and size among them, from the labels.
SEGORIENT_SEGMENTATION_EXPORT void collectMembers(Segmentation& segmentation);

/// Settings whose lengths are in the input's unit, in that of the cloud.
SEGORIENT_SEGMENTATION_EXPORT SegmentationOptions inUnitOf(const PreparedCloud& cloud,
                                                           const SegmentationOptions& options);

/// Normals and curvatures of a cloud's points from those of its rows, 4 floats a point.
SEGORIENT_SEGMENTATION_EXPORT std::vector<float> gatherNormals(const PreparedCloud& cloud,
                                                               const NormalView& row_normals);

/// Segments of a cloud's rows as segments of its points. \param normals 4 floats a point; without
/// one a point has label -1
SEGORIENT_SEGMENTATION_EXPORT Segmentation gather(const PreparedCloud& cloud,
                                                  const std::vector<float>& normals,
                                                  const Segmentation& of_rows);

/// Whether a row's normal points the other way than that of the row that stands for its point.
SEGORIENT_SEGMENTATION_EXPORT bool isTurned(const PreparedCloud& cloud,
                                            const PointView& row_normals, std::size_t row);

/// Segments of a cloud's points as segments of its rows, lengths in the input's unit. Rows that
/// repeat a point are in its segment: sizes are in rows, while labels stay as the points have them,
/// by descending size without repetition.
/// \param row_normals where rows have normals of their own: those that repeat a point may have the
///        opposite one; null where they have that of the point
SEGORIENT_SEGMENTATION_EXPORT Segmentation scatter(const PreparedCloud& cloud,
                                                   const Segmentation& of_points,
                                                   const PointView* row_normals = nullptr);

}  // namespace segorient::segmentation
