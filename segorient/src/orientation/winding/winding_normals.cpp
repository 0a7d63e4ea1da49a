// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/winding_normals.h"

#include <cmath>
#include <cstdint>

#include "common/dot.h"
#include "common/in_double.h"
#include "common/unit_vector.h"
#include "orientation/winding/dipole_fields.h"

namespace segorient {
namespace {

// Median residual, in spacings, above which it is noise: curvature alone leaves some hundredths.
// Noise makes the planes in the tip of a wedge lie between its faces, where they agree with each
// other, wrongly; below, the planes near an edge are of one face each.
constexpr float kNoisy = 0.1F;

std::vector<std::uint32_t> listDoubtful(const std::vector<float>& spacing, bool everywhere,
                                        const FilteredNormals& filtered) {
  std::vector<std::uint32_t> rows;
  for (std::size_t p = 0; p < spacing.size(); ++p) {
    if (!everywhere && filtered.confidences[p] >= kNothingToMend) continue;
    if (!std::isfinite(filtered.normals[4 * p])) continue;
    if (spacing[p] > 0.F) rows.push_back(static_cast<std::uint32_t>(p));
  }
  return rows;
}

// \param n which way the field falls \return whether the normal is another one now
bool tilt(const float* n, float* normal) {
  // Which of two near sheets a point is on is the segments' to say.
  return dot(n, normal) > 0.F && unitVector(inDouble(n), normal);
}

}  // namespace

std::size_t refineByWinding(const PointView& points, const std::vector<float>& spacing,
                            float residual, bool everywhere, int threads,
                            FilteredNormals& filtered) {
  const std::size_t n = points.size;
  if (spacing.size() != n || filtered.confidences.size() != n || filtered.normals.size() != 4 * n) {
    return 0;
  }
  if (!(residual >= kNoisy)) return 0;
  const std::vector<std::uint32_t> rows = listDoubtful(spacing, everywhere, filtered);
  if (rows.empty()) return 0;
  std::vector<float> at;
  std::vector<float> radii;
  for (const std::uint32_t p : rows) {
    at.insert(at.end(), {points[p][0], points[p][1], points[p][2], 0.F});
    radii.push_back((1.F + residual) * spacing[p]);
  }
  // Areas in a unit of their own: the direction of the field is all that is wanted.
  std::vector<float> areas(n, 0.F);
  for (std::size_t p = 0; p < n; ++p) {
    if (std::isfinite(spacing[p])) areas[p] = spacing[p] * spacing[p];
  }
  const std::vector<float> dipoles = dipolesOf(filtered.normals, areas);
  const std::vector<float> falls =
      steepestDescents({at.data(), 4, rows.size()}, {points, dipoles}, radii, threads);
  std::size_t changed = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (tilt(&falls[4 * k], &filtered.normals[4 * std::size_t{rows[k]}])) ++changed;
  }
  return changed;
}

}  // namespace segorient
