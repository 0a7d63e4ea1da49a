// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "search/index_impl.h"
#include "search/shared_block.h"

namespace segorient::search {

/// What one thread needs for its queries; kept from query to query.
class Workspace {
 public:
  /// Empty candidates with room for `capacity`, and no more, though there may be some from earlier:
  /// whether a guess does may decide what an approximate search finds.
  Candidates& candidates(std::size_t capacity) {
    if (capacity + Layout::kPadding > distance_.size()) {
      distance_.resize(capacity + Layout::kPadding);
      id_.resize(capacity + Layout::kPadding);
    }
    candidates_ = {distance_.data(), id_.data(), 0, capacity};
    return candidates_;
  }
  /// Gives back what an unusually large result took.
  void shrink() {
    if (distance_.size() <= kMostKept) return;
    distance_ = {};
    id_ = {};
    candidates_ = {nullptr, nullptr, 0, 0};
  }
  SortScratch sort() { return sort_.scratch(); }
  std::vector<std::pair<float, std::uint32_t>> pairs;
  std::vector<std::uint64_t> keys;
  Recent& recent(std::uint64_t index) { return recent_.of(index); }

 private:
  static constexpr std::size_t kMostKept = std::size_t{1} << 18;
  RecentPair recent_;
  std::vector<float> distance_;
  std::vector<std::uint32_t> id_;
  SortRoom sort_;
  Candidates candidates_{nullptr, nullptr, 0, 0};
};

/// The calling thread's.
Workspace& workspace();

/// What squared distances are multiplied by before they are compared: below 1 for an approximate
/// search.
float pruneFactor(float epsilon);

/// The squared distance to the nearest point of a box.
inline float squaredGap(const Box& box, const float* q) {
  float sum = 0.0F;
  for (int a = 0; a < 3; ++a) {
    const float d = std::max(std::max(box.lo[a] - q[a], q[a] - box.hi[a]), 0.0F);
    sum += d * d;
  }
  return sum;
}

}  // namespace segorient::search
