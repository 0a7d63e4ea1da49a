// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/segmentation/segmentation.h>
#include <segorient/common/impl/point_search.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace segorient {

/// A cloud with normals and segments, whoever made them, and the orientation of both.
struct OrientedSegmentation {
  /// The given one, or one of its own, with reference normals and signs as they were oriented.
  Segmentation segmentation;
  OrientationResult orientation;  ///< by row; signs relative to what was given
};

/// Orients a cloud that has normals: the stage after segmentation, on any rows (NaN and repeated
/// points included). A row that repeats a point follows that point.
/// \param normals one a row, signs arbitrary; NaN = the point has none. Curvatures are looked at
///        where segments are made; constant ones will do
/// \param segmentation of these rows, or null to make one by `segmentation_options`
/// \param k neighbours of a point, itself not counted; <= 0 = 32 for AUTO and 12 for the others
/// \param search finds neighbours among the rows; empty = a search of our own
/// \return empty if the sizes do not agree or a label is out of range
SEGORIENT_ORIENTATION_EXPORT OrientedSegmentation orientSegmentation(
    const PointView& points, const NormalView& normals, const Segmentation* segmentation, int k,
    const SegmentationOptions& segmentation_options, const OrientationOptions& options,
    const PointSearch& search = {});

/// Whether a table of neighbours has a row for each of so many points, refers to no others, and has
/// more in it than these.
SEGORIENT_ORIENTATION_EXPORT bool isTableOf(const Neighborhoods& table, std::size_t points);

/// Names of those settings of both that were changed from their defaults and that
/// orientSegmentation() does not look at.
SEGORIENT_ORIENTATION_EXPORT std::vector<std::string> settingsWithoutEffect(
    const SegmentationSettings& segmentation, const OrientationSettings& orientation,
    bool segments_are_given);

}  // namespace segorient
