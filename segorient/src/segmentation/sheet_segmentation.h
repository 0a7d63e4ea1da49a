// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <cstdint>
#include <vector>

#include "features/sheet_normals.h"

namespace segorient {

/// What is known of each point's own sheet: arrays of somebody else, one entry a point.
struct SheetField {
  const float* normals = nullptr;  ///< 4 floats: unoriented unit normal, residual in spacings
  const float* spacing = nullptr;  ///< h: mean distance to the 6 nearest
  const float* below = nullptr;    ///< lowest offset along the normal of the point's own sheet
  const float* above = nullptr;    ///< highest
  const std::uint8_t* reliable = nullptr;  ///< 1 where the normal can be trusted
  float residual = 0.F;                    ///< median residual, in spacings
};

/// What estimateSheetNormals() found; the arrays stay where they are.
SEGORIENT_SEGMENTATION_EXPORT SheetField fieldOf(const SheetNormals& sheets);

/// Neighbours of a point that segmentSheets() and borderVotes() look at.
constexpr int kSheetDegree = 16;

/// Options of segmentSheets(). Angles in radians.
struct SheetSegmentationOptions {
  /// Largest angle between neighbours' normals; 0 = 15 degrees on clean data to 20 on noisy.
  float alpha = 0.F;
  float beta = 0.5235988F;      ///< largest angle to the segment's reference normal (30 degrees)
  float epsilon = 0.1745329F;   ///< what clean-up allows beyond beta (10 degrees)
  std::uint32_t small = 20;     ///< segments with fewer points are cleaned up
  bool require_support = true;  ///< a point joins only with several neighbours inside
  bool clean_up = true;         ///< passes 1 and 2 of the paper
};

/// Bit j of entry p is set where p and its j-th neighbour (itself not counted) are on one sheet:
/// each within the other's sheet, and neither far off the other's tangent plane.
SEGORIENT_SEGMENTATION_EXPORT std::vector<std::uint32_t> admissibleEdges(
    const PointView& points, const Neighborhoods& neighborhoods, const SheetField& field,
    int threads = 0);

/// Segments that do not mix the two sides of a wall: growing as in section 2.3 of the paper, but
/// over admissible edges only, reliable points first, and with support from several neighbours, so
/// that a single leaking edge joins nothing. Leftovers down to single points stay segments: cutting
/// too much costs orientation little, mixing costs everything. Points without a normal have label
/// -1.
///
/// Growing is sequential: its order is part of the result.
SEGORIENT_SEGMENTATION_EXPORT Segmentation segmentSheets(
    const PointView& points, const Neighborhoods& neighborhoods, const SheetField& field,
    const std::vector<std::uint32_t>& admissible, const SheetSegmentationOptions& options = {});

}  // namespace segorient
