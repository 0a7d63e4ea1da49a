// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace segorient {

/// Numbers things by descending size, equal ones as they are.
class BySize {
 public:
  /// \param sizeOf of thing i below `count`
  template <typename SizeOf>
  BySize(std::size_t count, const SizeOf& sizeOf) : order_(count), rank_(count) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t l, std::size_t r) { return sizeOf(l) > sizeOf(r); });
    for (std::size_t r = 0; r < count; ++r) rank_[order_[r]] = static_cast<std::int32_t>(r);
  }

  const std::vector<std::size_t>& order() const { return order_; }  ///< the largest first
  /// The new number of a thing; below 0 stays below 0.
  std::int32_t operator()(std::int32_t old) const {
    return old < 0 ? old : rank_[static_cast<std::size_t>(old)];
  }
  void renumber(std::vector<std::int32_t>& numbers) const {
    for (std::int32_t& number : numbers) number = (*this)(number);
  }
  template <typename Thing>
  void sort(std::vector<Thing>& things) const {
    std::vector<Thing> sorted;
    for (const std::size_t i : order_) sorted.push_back(things[i]);
    things.swap(sorted);
  }

 private:
  std::vector<std::size_t> order_;
  std::vector<std::int32_t> rank_;
};

}  // namespace segorient
