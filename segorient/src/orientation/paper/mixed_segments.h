// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_result.h>

#include <cstdint>
#include <vector>

#include "orientation/paper/segment_relations.h"

namespace segorient {

/// How far an orientation agrees with what the borders say, in border points.
struct BorderBalance {
  float agreeing = 0.F;
  float contradicting = 0.F;

  /// 0 where there are no borders.
  float contradictingShare() const {
    const float total = agreeing + contradicting;
    return total > 0.F ? contradicting / total : 0.F;
  }
};

/// By segment: its borders with oriented segments, each weighed by its points and its margin.
std::vector<BorderBalance> balanceBorders(const SegmentGraph& links,
                                          const std::vector<BoundaryVote>& boundary,
                                          const std::vector<SegmentOrientationResult>& results);

/// By component of `results`, each border counted once. A share that is not near 0 means that the
/// surface is not orientable, or that segments mix two sides of it.
std::vector<BorderBalance> balanceComponents(const SegmentGraph& links,
                                             const std::vector<BoundaryVote>& boundary,
                                             const std::vector<SegmentOrientationResult>& results);

/// Segments that no sign of their own can be right for: more than a fifth of their border is
/// contradicted, and no neighbour across a contradicted border is worse off. Such a segment runs
/// from one side of the object over to another, where two bodies touch. Ascending.
std::vector<std::int32_t> findMixedSegments(const SegmentGraph& links,
                                            const std::vector<BoundaryVote>& boundary,
                                            const std::vector<SegmentOrientationResult>& results);

}  // namespace segorient
