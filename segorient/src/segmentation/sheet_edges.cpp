// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/sheet_edges.h"

#include "common/parallel_for.h"

namespace segorient {

SheetField fieldOf(const SheetNormals& sheets) {
  SheetField field;
  field.normals = sheets.normals.data();
  field.spacing = sheets.spacing.data();
  field.below = sheets.below.data();
  field.above = sheets.above.data();
  field.reliable = sheets.reliable.data();
  field.curvature = sheets.curvature.data();
  field.residual = sheets.residual;
  return field;
}

// Offsets off the tangent plane that curvature and noise explain.
SheetEdges::SheetEdges(const PointView& points, const SheetField& field)
    : points_(points),
      field_(field),
      offset_(std::clamp(0.25F + 2.2F * field.residual, 0.3F, 0.9F)) {}

std::vector<std::uint32_t> SheetEdges::list(const Neighborhoods& neighborhoods, int threads) const {
  std::vector<std::uint32_t> masks(points_.size, 0);
  parallelFor(points_.size, threads, 60.0, [&](std::size_t p) {
    if (!std::isfinite(field_.normals[4 * p])) return;
    const pcl::index_t* row = neighborhoods.indices(p) + 1;
    const int degree = std::min(neighborhoods.count(p) - 1, kSheetDegree);
    for (int j = 0; j < degree; ++j) {
      masks[p] |= static_cast<std::uint32_t>(join(p, static_cast<std::size_t>(row[j]))) << j;
    }
  });
  return masks;
}

}  // namespace segorient
