// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "features/sheet_normals.h"

namespace segorient {

/// What is known of each point's own sheet: arrays of somebody else, one entry a point.
struct SheetField {
  const float* normals = nullptr;  ///< 4 floats: unoriented unit normal, residual in spacings
  /// Smallest variance in the sum of all three, NaN without a plane; needed for segments only.
  const float* curvature = nullptr;
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

/// Tells which neighbours are on one sheet: each within the other's sheet, and neither far off the
/// other's tangent plane.
class SheetEdges {
 public:
  SheetEdges(const PointView& points, const SheetField& field);

  bool join(std::size_t p, std::size_t q) const {
    const float* n = field_.normals + 4 * p;
    const float* m = field_.normals + 4 * q;
    const float dx = points_[q][0] - points_[p][0];
    const float dy = points_[q][1] - points_[p][1];
    const float dz = points_[q][2] - points_[p][2];
    const float from_p = dx * n[0] + dy * n[1] + dz * n[2];
    const float from_q = -(dx * m[0] + dy * m[1] + dz * m[2]);
    const float limit = offset_ * std::max(field_.spacing[p], field_.spacing[q]);
    const bool near_planes = std::fabs(from_p) <= limit && std::fabs(from_q) <= limit;
    return near_planes && from_p > field_.below[p] && from_p < field_.above[p] &&
           from_q > field_.below[q] && from_q < field_.above[q];
  }

  /// For each point the neighbours that it is on one sheet with: bit j for the j-th, itself not
  /// counted.
  std::vector<std::uint32_t> list(const Neighborhoods& neighborhoods, int threads) const;

  const SheetField& field() const { return field_; }
  float offset() const { return offset_; }  ///< off a tangent plane at most, in spacings

 private:
  /// join() with four others: bit i for the i-th.
  unsigned int joinFour(std::size_t p, const std::array<std::size_t, 4>& others) const;

  PointView points_;
  SheetField field_;
  float offset_;
};

}  // namespace segorient
