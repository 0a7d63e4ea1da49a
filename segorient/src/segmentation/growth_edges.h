// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "segmentation/growth_state.h"

namespace segorient::segmentation {

/// Edge policies of growing: which neighbours it may go on to from a point, and whether a segment
/// that wants one has support for it.

/// By distances and tangent planes, as PairLimits has them.
struct LimitedEdges {
  PairLimits limits;

  std::uint32_t among(std::size_t /*p*/) const { return ~0U; }
  bool admits(const Node& p, const Node& q, std::size_t /*index*/) const {
    return limits.admissible(p, q);
  }
  bool supports(std::size_t /*q*/, std::int32_t /*label*/, std::uint32_t /*size*/) const {
    return true;
  }
};

/// Within single sheets, by SheetEdges.
struct ListedEdges {
  const GrowthState& state;
  std::vector<std::uint32_t> masks;  ///< see SheetEdges::list()
  const std::uint8_t* reliable;      ///< null = all points are

  std::uint32_t among(std::size_t p) const { return masks[p]; }
  bool admits(const Node& /*p*/, const Node& /*q*/, std::size_t index) const {
    return reliable == nullptr || reliable[index] != 0;
  }

  // As GrowthState::supports().
  bool supports(std::size_t q, std::int32_t label, std::uint32_t size) const {
    constexpr std::uint32_t kYoung = 6;  // a segment that small has not so many to offer
    const int wanted = size <= kYoung ? 0 : state.support;
    const pcl::index_t* row = state.neighborhoods->indices(q) + 1;
    const int last = state.rowSize(q) - 1;
    int good = 0;
    int bad = 0;
    // Most points have one sheet around them, so that nothing can speak against it.
    const bool one_sheet = state.support == 0 || masks[q] == (1U << last) - 1U;
    for (int j = 0; j < last && !(one_sheet && good >= wanted); ++j) {
      if (state.labels[static_cast<std::size_t>(row[j])] != label) continue;
      ((masks[q] >> j & 1U) != 0 ? good : bad) += 1;
    }
    return one_sheet ? good >= wanted : bad <= good && good >= wanted;
  }
};

}  // namespace segorient::segmentation
