// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "segmentation/border_test.h"

namespace segorient::segmentation {

/// Sets of segments that know whether a segment's signs disagree with its root's, and which others
/// they meet at a sharp border.
class SegmentSets {
 public:
  explicit SegmentSets(std::size_t size) : parent_(size), flipped_(size, 0), apart_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  std::pair<std::int32_t, bool> find(std::int32_t s) {
    std::int32_t root = s;
    bool flipped = false;
    for (; parent(root) != root; root = parent(root)) flipped ^= isFlipped(root);
    for (bool rest = flipped; parent(s) != root && s != root;) {
      const auto at = static_cast<std::size_t>(s);
      const bool next = rest ^ isFlipped(s);
      s = std::exchange(parent_[at], root);
      flipped_[at] = rest ? 1 : 0;
      rest = next;
    }
    return {root, flipped};
  }

  void keepApart(std::int32_t a, std::int32_t b) {
    apart_[static_cast<std::size_t>(a)].push_back(b);
    apart_[static_cast<std::size_t>(b)].push_back(a);
  }

  // A sliver on an edge that looks smooth towards both faces does not join them.
  void unite(const TestedBorder& border) {
    const auto [root_a, flipped_a] = find(border.a);
    const auto [root_b, flipped_b] = find(border.b);
    if (root_a == root_b || mustStayApart(root_a, root_b)) return;
    const auto root = static_cast<std::size_t>(std::min(root_a, root_b));
    const auto child = static_cast<std::size_t>(std::max(root_a, root_b));
    parent_[child] = static_cast<std::int32_t>(root);
    flipped_[child] = static_cast<std::uint8_t>((flipped_a != flipped_b) != border.flipped);
    if (apart_[root].size() < apart_[child].size()) apart_[root].swap(apart_[child]);
    apart_[root].insert(apart_[root].end(), apart_[child].begin(), apart_[child].end());
    apart_[child] = {};
  }

 private:
  std::int32_t parent(std::int32_t s) const { return parent_[static_cast<std::size_t>(s)]; }
  bool isFlipped(std::int32_t s) const { return flipped_[static_cast<std::size_t>(s)] != 0; }

  bool mustStayApart(std::int32_t root_a, std::int32_t root_b) {
    if (apart_[static_cast<std::size_t>(root_b)].size() <
        apart_[static_cast<std::size_t>(root_a)].size()) {
      std::swap(root_a, root_b);
    }
    const auto& others = apart_[static_cast<std::size_t>(root_a)];
    return std::any_of(others.begin(), others.end(),
                       [&](std::int32_t s) { return find(s).first == root_b; });
  }

  std::vector<std::int32_t> parent_;
  std::vector<std::uint8_t> flipped_;  ///< against the parent
  std::vector<std::vector<std::int32_t>> apart_;
};

}  // namespace segorient::segmentation
