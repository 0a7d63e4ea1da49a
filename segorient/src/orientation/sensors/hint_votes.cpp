// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/hint_votes.h"

#include <cmath>
#include <cstddef>

#include "common/dot.h"

namespace segorient::detail {
namespace {

// What is seen edge-on says little: each vote weighs as much as it points along the normal.
void vote(const float* normal, float sign, const float* direction, Ballot& ballot) {
  ballot.add(sign * dot(normal, direction));
}

}  // namespace

std::vector<HintVotes> hintVotes(const PointView& points, const SheetField& field,
                                 const Segmentation& segmentation, const PointHints& hints) {
  std::vector<HintVotes> votes(segmentation.segments.size());
  const bool by_point = hints.has_viewpoint || !hints.directions.empty();
  for (std::size_t i = 0; by_point && i < points.size; ++i) {
    const std::int32_t s = segmentation.labels[i];
    if (s < 0) continue;
    HintVotes& mine = votes[static_cast<std::size_t>(s)];
    const float* n = field.normals + 4 * i;
    const float sign = segmentation.signs[i];
    if (!hints.directions.empty()) vote(n, sign, &hints.directions[3 * i], mine.directions);
    if (!hints.has_viewpoint) continue;
    float to_viewpoint[3];
    for (std::size_t a = 0; a < 3; ++a) to_viewpoint[a] = hints.viewpoint[a] - points[i][a];
    const float facing = sign * dot(n, to_viewpoint);
    if (facing != 0.F) mine.view.add(facing > 0.F ? 1.F : -1.F);
  }
  for (const PointHints::Seed& seed : hints.seeds) {
    const std::int32_t s = segmentation.labels[seed.point];
    if (s < 0) continue;
    vote(field.normals + 4 * seed.point, segmentation.signs[seed.point], seed.normal.data(),
         votes[static_cast<std::size_t>(s)].seeds);
  }
  return votes;
}

}  // namespace segorient::detail
