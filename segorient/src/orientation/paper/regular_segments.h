// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/segmentation/segmentation.h>

#include <cstdint>
#include <vector>

#include "orientation/paper/extremal_points.h"
#include "orientation/paper/mixed_segments.h"

namespace segorient {

/// Regular segments oriented relative to each other.
struct OrientedRegularSegments {
  std::vector<SegmentOrientationResult> results;  ///< by label; sign 0 for all others
  /// Labels of those that run over two sides, and so have no sign of their own.
  std::vector<std::int32_t> mixed;
  std::vector<BorderBalance> components;  ///< by component of `results`
  std::vector<ExtremalPoint> extremal;    ///< of the whole cloud, if the method asks them
};

/// Runs one of the paper's methods. With options.check_borders, segments that turn out to be mixed
/// are left out and the rest is oriented anew.
OrientedRegularSegments orientRegularSegments(const PointView& points, const PointView& normals,
                                              const Neighborhoods& neighborhoods,
                                              const Segmentation& segmentation,
                                              const OrientationOptions& options);

}  // namespace segorient
