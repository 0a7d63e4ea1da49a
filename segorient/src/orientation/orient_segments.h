// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/segmentation/segmentation.h>

#include "orientation/sensors/point_hints.h"

namespace segorient {
namespace detail {
struct AutoStages;
}

/// Orients a segmented cloud: segments by the chosen method, every other point that has a normal
/// from what surrounds it, and every connected component outward (paper, section 3).
///
/// \param normals 4 floats a row; the sign of each is arbitrary
/// \param neighborhoods of every point
/// \param graph of the segmentation, see buildSegmentGraph()
/// \param own for AUTO, where not null: what its stages found; in place of `segmentation` its own
///        segments are oriented
/// \return all signs 0 if the sizes do not agree
OrientationResult orientSegments(const PointView& points, const PointView& normals,
                                 const Neighborhoods& neighborhoods,
                                 const Segmentation& segmentation, const SegmentGraph& graph,
                                 const OrientationOptions& options, const PointHints& hints = {},
                                 detail::AutoStages* own = nullptr);

}  // namespace segorient
