// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/sheet_edges.h"

#include "common/parallel_for.h"
#include "common/quads.h"

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

unsigned int SheetEdges::joinFour(std::size_t p, const std::array<std::size_t, 4>& others) const {
  Quad q[4];
  Quad m[4];
  for (std::size_t i = 0; i < others.size(); ++i) {
    q[i] = loadPoint(points_, others[i]);
    m[i] = loadQuad(field_.normals + 4 * others[i]);
  }
  transpose(q[0], q[1], q[2], q[3]);
  transpose(m[0], m[1], m[2], m[3]);
  const auto gathered = [&others](const float* of) {
    return Quad{of[others[0]], of[others[1]], of[others[2]], of[others[3]]};
  };
  const float* const own = points_[p];
  const float* const n = field_.normals + 4 * p;
  const Quad dx = q[0] - own[0];
  const Quad dy = q[1] - own[1];
  const Quad dz = q[2] - own[2];
  const Quad from_p = dx * n[0] + dy * n[1] + dz * n[2];
  const Quad from_q = -(dx * m[0] + dy * m[1] + dz * m[2]);
  const Quad spacing = gathered(field_.spacing);
  const float own_spacing = field_.spacing[p];
  const Quad limit =
      offset_ * SEGORIENT_CHOSEN(spacing > own_spacing, spacing, Quad{} + own_spacing);
  const auto joined = (from_p <= limit) & (from_p >= -limit) & (from_q <= limit) &
                      (from_q >= -limit) & (from_p > field_.below[p]) & (from_p < field_.above[p]) &
                      (from_q > gathered(field_.below)) & (from_q < gathered(field_.above));
  const auto bit = [&joined](std::size_t j) {
    return static_cast<unsigned int>(joined[j]) & 1U << j;
  };
  return bit(0) | bit(1) | bit(2) | bit(3);
}

std::vector<std::uint32_t> SheetEdges::list(const Neighborhoods& neighborhoods, int threads) const {
  std::vector<std::uint32_t> masks(points_.size, 0);
  parallelFor(points_.size, threads, 40.0, [&](std::size_t p) {
    if (!std::isfinite(field_.normals[4 * p])) return;
    const pcl::index_t* row = neighborhoods.indices(p) + 1;
    const int degree = std::min(neighborhoods.count(p) - 1, kSheetDegree);
    const auto other = [row](int j) { return static_cast<std::size_t>(row[j]); };
    std::uint32_t mask = 0;
    int j = 0;
    for (; j + 4 <= degree; j += 4) {
      mask |= joinFour(p, {other(j), other(j + 1), other(j + 2), other(j + 3)}) << j;
    }
    for (; j < degree; ++j) mask |= static_cast<std::uint32_t>(join(p, other(j))) << j;
    masks[p] = mask;
  });
  return masks;
}

}  // namespace segorient
