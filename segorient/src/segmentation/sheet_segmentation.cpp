// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/sheet_segmentation.h"

#include <algorithm>
#include <cmath>

#include "common/threads.h"
#include "segmentation/sheet_grower.h"

namespace segorient {

SheetField fieldOf(const SheetNormals& sheets) {
  SheetField field;
  field.normals = sheets.normals.data();
  field.spacing = sheets.spacing.data();
  field.below = sheets.below.data();
  field.above = sheets.above.data();
  field.reliable = sheets.reliable.data();
  field.residual = sheets.residual;
  return field;
}

std::vector<std::uint32_t> admissibleEdges(const PointView& points, const Neighborhoods& nb,
                                           const SheetField& field, int threads) {
  // Offsets off the tangent plane that curvature and noise explain.
  const float kappa = std::clamp(0.25F + 2.2F * field.residual, 0.3F, 0.9F);
  std::vector<std::uint32_t> masks(points.size, 0);
  const int t = resolveThreads(threads, points.size, 60.0);
#pragma omp parallel for num_threads(t) schedule(dynamic, 4096)
  for (std::size_t p = 0; p < points.size; ++p) {
    const float* n = field.normals + 4 * p;
    if (!std::isfinite(n[0])) continue;
    const pcl::index_t* row = nb.indices(p) + 1;
    const int degree = std::min(nb.count(p) - 1, kSheetDegree);
    std::uint32_t mask = 0;
    for (int j = 0; j < degree; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const float* m = field.normals + 4 * q;
      const float dx = points[q][0] - points[p][0];
      const float dy = points[q][1] - points[p][1];
      const float dz = points[q][2] - points[p][2];
      const float from_p = dx * n[0] + dy * n[1] + dz * n[2];
      const float from_q = -(dx * m[0] + dy * m[1] + dz * m[2]);
      const float limit = kappa * std::max(field.spacing[p], field.spacing[q]);
      const bool near_planes = std::fabs(from_p) <= limit && std::fabs(from_q) <= limit;
      const bool one_sheet = from_p > field.below[p] && from_p < field.above[p] &&
                             from_q > field.below[q] && from_q < field.above[q];
      mask |= static_cast<std::uint32_t>(near_planes && one_sheet) << j;
    }
    masks[p] = mask;
  }
  return masks;
}

Segmentation segmentSheets(const PointView& points, const Neighborhoods& neighborhoods,
                           const SheetField& field, const std::vector<std::uint32_t>& admissible,
                           const SheetSegmentationOptions& options) {
  detail::SheetGrower grower(points, neighborhoods, field, admissible, options);
  grower.growAll();
  if (options.clean_up) {
    grower.mergeSmall();
    grower.extractFromSmall();
  }
  return grower.finish();
}

}  // namespace segorient
