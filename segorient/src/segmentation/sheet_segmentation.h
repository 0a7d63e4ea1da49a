// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include "segmentation/sheet_edges.h"

namespace segorient {

/// Options of segmentSheets().
struct SheetSegmentationOptions : SegmentationOptions {
  bool require_support = true;  ///< a point joins only with several neighbours inside
  bool clean_up = true;         ///< passes 1 and 2 of the paper

  /// Alpha 0 = 15 degrees on clean data to 20 on noisy.
  SheetSegmentationOptions() { alpha = 0.F; }
};

/// Segments as a user wants to see them, and how.
struct FinishedSegments {
  SegmentationOptions options;  ///< of the clean-up; what they say about growing is not used
  Segmentation segmentation;    ///< the result, members not listed: see collectMembers()
  /// GrowthState::typical_offset: what it is of the whole cloud, where these are a part of it, else
  /// negative, and what was measured afterwards.
  float typical_offset = -1.F;
};

/// Segments that do not mix the two sides of a wall: growing and clean-up as in section 2.3 of the
/// paper, but over the edges of SheetEdges only, reliable points first, and with support from
/// several neighbours, so that a single leaking edge joins nothing. Leftovers down to single points
/// stay segments: cutting too much costs orientation little, mixing costs everything. Points
/// without a normal have label -1.
///
/// Growing is sequential: its order is part of the result.
///
/// \param finished where not null: the same after the clean-up of segmentByNormals(). A point of a
///        thin part that goes over to the other side's segment that way must not be turned over
///        with it, so signs are not to be found by these
SEGORIENT_SEGMENTATION_EXPORT Segmentation
segmentSheets(const PointView& points, const Neighborhoods& neighborhoods, const SheetField& field,
              const SheetSegmentationOptions& options = {}, FinishedSegments* finished = nullptr);

}  // namespace segorient
