// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::detail {

/// A small set of point indices that is cleared in the time it took to fill: a hash table with open
/// addressing. Grows as needed.
class PointSet {
 public:
  PointSet() : slots_(std::size_t{1} << bits_, kFree) {}

  void clear() {
    for (const std::size_t s : used_) slots_[s] = kFree;
    used_.clear();
  }

  /// \return whether it was not yet in
  bool insert(std::size_t point) {
    const std::size_t s = slotOf(point);
    if (slots_[s] == point) return false;
    slots_[s] = point;
    used_.push_back(s);
    if (2 * used_.size() >= slots_.size()) grow();
    return true;
  }

 private:
  static constexpr std::size_t kFree = ~std::size_t{0};

  std::size_t slotOf(std::size_t point) const {
    // Fibonacci hashing spreads neighbouring indices.
    auto s =
        static_cast<std::size_t>((std::uint64_t{point} * 0x9E3779B97F4A7C15ULL) >> (64U - bits_));
    while (slots_[s] != kFree && slots_[s] != point) s = (s + 1) & (slots_.size() - 1);
    return s;
  }
  void grow() {
    std::vector<std::size_t> points;
    for (const std::size_t s : used_) points.push_back(slots_[s]);
    ++bits_;
    slots_.assign(std::size_t{1} << bits_, kFree);
    used_.clear();
    for (const std::size_t p : points) {
      const std::size_t s = slotOf(p);
      slots_[s] = p;
      used_.push_back(s);
    }
  }

  unsigned bits_ = 10;
  std::vector<std::size_t> slots_;
  std::vector<std::size_t> used_;
};

}  // namespace segorient::detail
