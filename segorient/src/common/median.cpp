// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/median.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace segorient {
namespace {

// So few are left to the library.
constexpr std::size_t kFew = 16;
// And those of which a pass has left more than this: values whose period is that of the pivots, or
// that are no numbers.
constexpr double kPoor = 7.0 / 8.0;

float middleOf(float a, float b, float c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

// The median of the medians of three triples from all over.
float pivotOf(const float* values, std::size_t count) {
  const auto at = [&](std::size_t eighths) { return values[eighths * (count - 1) / 8]; };
  return middleOf(middleOf(at(0), at(1), at(2)), middleOf(at(3), at(4), at(5)),
                  middleOf(at(6), at(7), at(8)));
}

// Copies those that `is_first` says to the front, the others to the back; without a branch, as no
// processor foretells what values are. \return how many came to the front
template <typename IsFirst>
std::size_t part(const float* from, std::size_t count, float* to, const IsFirst& is_first) {
  std::size_t front = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float v = from[i];
    to[front] = v;
    to[count - 1 - (i - front)] = v;
    front += is_first(v) ? 1 : 0;
  }
  return front;
}

}  // namespace

float median(std::vector<float> values) {
  if (values.empty()) return 0.F;
  std::vector<float> other(values.size());
  float* from = values.data();
  float* to = other.data();
  std::size_t count = values.size();
  std::size_t rank = count / 2;
  while (count > kFew) {
    const float pivot = pivotOf(from, count);
    std::size_t less = part(from, count, to, [pivot](float v) { return v < pivot; });
    if (less == 0) {
      // Nothing is less than the pivot: then those that are no more than it are parted from the
      // rest.
      less = part(from, count, to, [pivot](float v) { return v <= pivot; });
      if (rank < less) return pivot;
    }
    std::swap(from, to);
    const std::size_t before = count;
    if (rank < less) {
      count = less;
    } else {
      rank -= less;
      count -= less;
      from += less;
      to += less;
    }
    if (static_cast<double>(count) > kPoor * static_cast<double>(before)) break;
  }
  std::nth_element(from, from + rank, from + count);
  return from[rank];
}

}  // namespace segorient
