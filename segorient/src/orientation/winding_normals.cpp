// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/threads.h>
#include <segorient/orientation/winding_normals.h>
#include <segorient/orientation/winding_number.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace segorient {
namespace {

constexpr float kNoisy = 0.1F;  // in spacings; below, the planes near an edge are of one face each
constexpr float kAgreed = 0.97F;  // confidence from which on there is nothing to mend

std::vector<std::uint32_t> listDoubtful(const std::vector<float>& spacing,
                                        const FilteredNormals& filtered) {
  std::vector<std::uint32_t> rows;
  for (std::size_t p = 0; p < spacing.size(); ++p) {
    if (filtered.confidences[p] >= kAgreed || !std::isfinite(filtered.normals[4 * p])) continue;
    if (spacing[p] > 0.F) rows.push_back(static_cast<std::uint32_t>(p));
  }
  return rows;
}

// Areas in a unit of their own: the direction of the field is all that is wanted.
std::vector<float> dipolesOf(const std::vector<float>& spacing, const FilteredNormals& filtered) {
  std::vector<float> dipoles(4 * spacing.size(), 0.F);
  for (std::size_t p = 0; p < spacing.size(); ++p) {
    if (!std::isfinite(filtered.normals[4 * p])) continue;
    const float area = spacing[p] * spacing[p];
    for (std::size_t a = 0; a < 3; ++a) dipoles[4 * p + a] = area * filtered.normals[4 * p + a];
    dipoles[4 * p + 3] = area;
  }
  return dipoles;
}

}  // namespace

std::size_t refineByWinding(const PointView& points, const std::vector<float>& spacing,
                            float residual, int threads, FilteredNormals& filtered) {
  if (residual < kNoisy) return 0;
  const std::vector<std::uint32_t> rows = listDoubtful(spacing, filtered);
  if (rows.empty()) return 0;
  const std::vector<float> dipoles = dipolesOf(spacing, filtered);
  WindingNumber field;
  field.build(points, dipoles, {});
  std::size_t changed = 0;
#pragma omp parallel for num_threads(resolveThreads(threads)) schedule(dynamic, 256) \
    reduction(+ : changed)
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t p = rows[k];
    std::array<float, 3> n{};
    field.steepestDescent(points[p], (1.F + residual) * spacing[p], n.data());
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!std::isfinite(length) || length < 1e-30F) continue;
    float* normal = filtered.normals.data() + 4 * p;
    // Which of two near sheets a point is on is the segments' to say.
    if (!(n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2] > 0.F)) continue;
    for (std::size_t a = 0; a < 3; ++a) normal[a] = n[a] / length;
    ++changed;
  }
  return changed;
}

}  // namespace segorient
