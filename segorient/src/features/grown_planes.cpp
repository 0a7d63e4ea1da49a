// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/grown_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "common/compiler.h"
#include "common/vectors.h"
#include "common/widest.h"

namespace segorient::detail {
namespace {

// What to compare, two by two, so that all are sorted then: merging by odd and even places (Knuth,
// The Art of Computer Programming, vol. 3, algorithm 5.2.2M).
// \param take gets each pair
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

constexpr std::size_t countSortingPairs() {
  std::size_t pairs = 0;
  forEachSortingPair(kMostMedian, [&pairs](std::size_t, std::size_t) { ++pairs; });
  return pairs;
}

struct SortingPair {
  std::size_t first = 0, second = 0;
};

constexpr auto listSortingPairs() {
  std::array<SortingPair, countSortingPairs()> out{};
  std::size_t size = 0;
  forEachSortingPair(kMostMedian, [&](std::size_t first, std::size_t second) {
    out[size].first = first;
    out[size++].second = second;
  });
  return out;
}

// By the algorithm above.
constexpr auto kSortingPairs = listSortingPairs();

}  // namespace

#define SEGORIENT_KERNELS "features/grown_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

Plane GrownPlanes::at(std::size_t i, float length) const {
  const float scale = unit[i] / length;
  Plane plane;
  plane.normal = {normal[0][i], normal[1][i], normal[2][i]};
  plane.lambda = Eigen::Vector3f(lambda[0][i], lambda[1][i], lambda[2][i]) * (scale * scale);
  plane.mean = Eigen::Vector3f(mean[0][i], mean[1][i], mean[2][i]) * scale;
  plane.valid = n[i] >= 3.F && spansTwo(plane.lambda) && plane.normal.allFinite();
  return plane;
}

void fitGrownPlanes(const LocalFitJob& job, const int* sizes, std::size_t count, std::size_t begin,
                    std::size_t end, GrownPlanes* planes) {
  SEGORIENT_WIDEST(fitGrown)(job, sizes, count, begin, end, planes);
}

void findMedians(const float* values, std::size_t count, float* medians) {
  SEGORIENT_WIDEST(mediansOf)(values, count, medians);
}

}  // namespace segorient::detail
