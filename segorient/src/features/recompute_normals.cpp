// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/recompute_normals.h"

#include <algorithm>

#include "features/recompute_scene.h"

namespace segorient {

RecomputationReport recomputeNormals(const PointView& points, const Neighborhoods& neighborhoods,
                                     const std::vector<std::uint8_t>& regular,
                                     const RecomputationOptions& options,
                                     std::vector<std::int32_t>& labels,
                                     std::vector<float>& normals) {
  RecomputationReport report;
  if (neighborhoods.size() != points.size || labels.size() != points.size ||
      normals.size() != 4 * points.size) {
    return report;
  }
  const int entries =
      options.k > 0 ? std::min(options.k, neighborhoods.k() - 1) + 1 : neighborhoods.k();
  const detail::RecomputationScene scene{points,  neighborhoods, regular,        labels,
                                         normals, entries,       options.threads};
  const std::vector<detail::Recomputed> results =
      options.rule == RecomputationRule::ONE_SIDED
          ? detail::OneSidedRule(options).apply(scene)
          : detail::applyModifiedNeighborhoods(scene, options);
  for (const detail::Recomputed& r : results) {
    ++report.examined;
    if (!r.accepted) continue;
    ++report.recomputed;
    if (labels[r.point] != r.label) ++report.moved;
    labels[r.point] = r.label;
    float* n = &normals[4 * r.point];
    const bool flip = n[0] * r.normal[0] + n[1] * r.normal[1] + n[2] * r.normal[2] < 0.0F;
    for (int a = 0; a < 3; ++a) n[a] = flip ? -r.normal[a] : r.normal[a];
  }
  return report;
}

}  // namespace segorient
