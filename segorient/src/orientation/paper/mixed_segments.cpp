// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/mixed_segments.h"

#include <cmath>
#include <cstddef>

#include "common/at.h"
#include "orientation/paper/segment_links.h"

namespace segorient {
namespace {

// Border points that agree (positive) or not with the signs on both sides; 0 where one has none.
float agreement(const SegmentBorder& link, const BoundaryVote& vote,
                const std::vector<SegmentOrientationResult>& results) {
  const int signs = results[at(link.a)].sign * results[at(link.b)].sign;
  return static_cast<float>(signs) * vote.margin * static_cast<float>(vote.points);
}

void add(float agreeing, BorderBalance& balance) {
  (agreeing < 0.F ? balance.contradicting : balance.agreeing) += std::abs(agreeing);
}

}  // namespace

std::vector<BorderBalance> balanceBorders(const SegmentGraph& links,
                                          const std::vector<BoundaryVote>& boundary,
                                          const std::vector<SegmentOrientationResult>& results) {
  std::vector<BorderBalance> out(results.size());
  for (std::size_t l = 0; l < links.borders.size(); ++l) {
    const float agreeing = agreement(links.borders[l], boundary[l], results);
    add(agreeing, out[at(links.borders[l].a)]);
    add(agreeing, out[at(links.borders[l].b)]);
  }
  return out;
}

std::vector<BorderBalance> balanceComponents(const SegmentGraph& links,
                                             const std::vector<BoundaryVote>& boundary,
                                             const std::vector<SegmentOrientationResult>& results) {
  std::vector<BorderBalance> out;
  for (const SegmentOrientationResult& result : results) {
    if (result.component >= 0 && at(result.component) >= out.size()) {
      out.resize(at(result.component) + 1);
    }
  }
  for (std::size_t l = 0; l < links.borders.size(); ++l) {
    const std::int32_t component = results[at(links.borders[l].a)].component;
    if (component >= 0) add(agreement(links.borders[l], boundary[l], results), out[at(component)]);
  }
  return out;
}

std::vector<std::int32_t> findMixedSegments(const SegmentGraph& links,
                                            const std::vector<BoundaryVote>& boundary,
                                            const std::vector<SegmentOrientationResult>& results) {
  constexpr float kMostContradicted = 0.2F;
  const std::vector<BorderBalance> balance = balanceBorders(links, boundary, results);
  std::vector<std::int32_t> out;
  for (std::size_t s = 0; s < results.size(); ++s) {
    const float share = balance[s].contradictingShare();
    if (!(share > kMostContradicted)) continue;
    bool worst = true;
    for (const std::uint32_t l : LinksOf(links, static_cast<std::int32_t>(s))) {
      if (agreement(links.borders[l], boundary[l], results) >= 0.F) continue;
      const std::int32_t other = otherOf(links.borders[l], static_cast<std::int32_t>(s));
      const float others = balance[at(other)].contradictingShare();
      // Of two that are equal, the larger one (smaller label) stays.
      worst = worst && (share > others || (share == others && at(other) < s));
    }
    if (worst) out.push_back(static_cast<std::int32_t>(s));
  }
  return out;
}

}  // namespace segorient
