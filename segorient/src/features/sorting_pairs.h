// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>

namespace segorient::detail {

struct SortingPair {
  std::size_t first = 0, second = 0;
};

/// What to compare, two by two, so that all are sorted then: merging by odd and even places (Knuth,
/// The Art of Computer Programming, vol. 3, algorithm 5.2.2M).
/// \param take gets each pair
template <typename Take>
constexpr void forEachSortingPair(std::size_t count, Take&& take) {
  std::size_t half = 1;
  while (2 * half < count) half *= 2;
  for (std::size_t p = half; p > 0; p /= 2) {
    std::size_t r = 0;
    std::size_t d = p;
    for (std::size_t q = half; q >= p; q /= 2) {
      for (std::size_t i = 0; i + d < count; ++i) {
        if ((i & p) == r) take(i, i + d);
      }
      d = q - p;
      r = p;
    }
  }
}

constexpr std::size_t countSortingPairs(std::size_t count) {
  std::size_t pairs = 0;
  forEachSortingPair(count, [&pairs](std::size_t, std::size_t) { ++pairs; });
  return pairs;
}

template <std::size_t kCount>
constexpr auto listSortingPairs() {
  std::array<SortingPair, countSortingPairs(kCount)> out{};
  std::size_t size = 0;
  forEachSortingPair(kCount, [&](std::size_t first, std::size_t second) {
    out[size].first = first;
    out[size++].second = second;
  });
  return out;
}

/// By the algorithm above, for kCount values.
template <std::size_t kCount>
constexpr auto kSortingPairs = listSortingPairs<kCount>();

}  // namespace segorient::detail
