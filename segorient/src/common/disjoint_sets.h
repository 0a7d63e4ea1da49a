// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace segorient::detail {

/// Sets of the numbers below a size, each at first on its own (union-find). The smallest number of
/// a set is its root, so that nothing depends on the order in which sets are joined.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::int32_t find(std::int32_t s) {
    while (parent(s) != s) s = parent(s) = parent(parent(s));
    return s;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    parent(std::max(a, b)) = std::min(a, b);
  }
  /// Makes a root part of another one's set, whichever number is smaller.
  void hang(std::int32_t root, std::int32_t other_root) { parent(root) = other_root; }

 private:
  std::int32_t& parent(std::int32_t s) { return parent_[static_cast<std::size_t>(s)]; }
  std::vector<std::int32_t> parent_;
};

}  // namespace segorient::detail
