// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "segmentation/growth_state.h"

namespace segorient::segmentation {

/// Edge policies of growing: which neighbours it may go on to from a point, and whether a segment
/// that wants one has support for it.

/// By distances and tangent planes, as PairLimits has them.
struct LimitedEdges {
  static constexpr bool kLooksAtRows = false;  ///< of candidates, before these are accepted
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
  static constexpr bool kLooksAtRows = true;
  const GrowthState& state;
  const std::uint8_t* reliable;  ///< null = all points are

  std::uint32_t among(std::size_t p) const { return state.joined[p]; }
  bool admits(const Node& /*p*/, const Node& /*q*/, std::size_t index) const {
    return reliable == nullptr || reliable[index] != 0;
  }

  // As GrowthState::supports().
  bool supports(std::size_t q, std::int32_t label, std::uint32_t size) const {
    constexpr std::uint32_t kYoung = 6;  // a segment that small has not so many to offer
    const int wanted = size <= kYoung ? 0 : state.support;
    const std::uint32_t members = state.membersAmong(q, label);
    const int good = countBits(members & state.joined[q]);
    const int bad = countBits(members & ~state.joined[q]);
    return good >= wanted && (state.support == 0 || bad <= good);
  }
};

}  // namespace segorient::segmentation
