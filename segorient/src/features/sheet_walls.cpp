// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/vectors.h"
#include "common/widest.h"
#include "features/sorting_pairs.h"

namespace segorient::detail {
namespace {

using Values = std::array<float, kWallEntries>;

// Fewer points have no plane with a residual.
constexpr std::size_t kLeastOfWall = 4;
// In spacings: nearer than that, offsets of neighbours do not fall into two groups.
constexpr float kLeastApart = 0.35F;
// Two classes, each thin, are two walls: of the variance that much at most is left within them. One
// wall, divided in the middle, leaves a quarter where offsets are spread evenly, .36 where they are
// normally distributed.
constexpr float kWithin = 0.2F;
// Nothing is between two walls: that much of their distance at least. Of 33 offsets spread evenly,
// neighbours are 1/16 of the distance of both halves' means apart.
constexpr float kEmpty = 0.15F;

// Each value's place is the number of those before it: a thousand comparisons without a branch take
// a quarter of the time of std::sort.
Values sorted(const Values& t, std::size_t n) {
  Values out{};
  for (std::size_t i = 0; i < n; ++i) {
    std::uint32_t before = 0;
    for (std::size_t j = 0; j < i; ++j) before += t[j] <= t[i] ? 1U : 0U;
    for (std::size_t j = i + 1; j < n; ++j) before += t[j] < t[i] ? 1U : 0U;
    out[before] = t[i];
  }
  return out;
}

#define SEGORIENT_KERNELS "features/wall_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

}  // namespace

std::uint32_t seesTwoWalls(const WallRows& of) {
  return SEGORIENT_WIDEST(findTwoWalls)(of);
}

WallSplit splitWalls(const Offsets& o, const Eigen::Vector3f& normal, float most_apart) {
  const auto n = static_cast<std::size_t>(o.n) + 1;
  WallSplit split;
  if (n < 2 * kLeastOfWall) return split;
  Values offsets{};
  float lowest = 0.F;
  float highest = 0.F;
  for (std::size_t j = 1; j < n; ++j) {
    offsets[j] = o.along(j - 1, normal);
    lowest = std::min(lowest, offsets[j]);
    highest = std::max(highest, offsets[j]);
  }
  if (highest - lowest <= kLeastApart) return split;
  const Values t = sorted(offsets, n);
  Values left;  // sums up to each
  float sum = 0.F;
  float squares = 0.F;
  for (std::size_t j = 0; j < n; ++j) {
    sum += t[j];
    squares += t[j] * t[j];
    left[j] = sum;
  }
  const auto count = static_cast<float>(n);
  const float total = squares - sum * sum / count;
  if (!(total > 0.F)) return split;

  const std::size_t last = n - kLeastOfWall;
  Values gap;
  Values value;
  for (std::size_t j = kLeastOfWall - 1; j < last; ++j) {
    const auto a = static_cast<float>(static_cast<int>(j) + 1);
    const float b = count - a;
    gap[j] = (sum - left[j]) / b - left[j] / a;
    value[j] = a * b / count * gap[j] * gap[j];
  }
  const auto* best = std::max_element(&value[kLeastOfWall - 1], &value[last]);
  const auto at = static_cast<std::size_t>(best - value.data());
  const float between = *best;
  const float apart = gap[at];
  const float low = t[at];
  const float high = t[at + 1];
  if (apart > most_apart) return split;
  if (total - between >= kWithin * total || apart <= kLeastApart || high - low <= kEmpty * apart)
    return split;
  split.found = true;
  const float middle = 0.5F * (low + high);
  (middle > 0.F ? split.above : split.below) = middle;
  return split;
}

Plane fitWithin(const Offsets& o, const Eigen::Vector3f& normal, const WallSplit& split) {
  Moments m;
  m.addOrigin();
  for (std::size_t j = 0; j < static_cast<std::size_t>(o.n); ++j) {
    const float t = o.along(j, normal);
    if (t > split.below && t < split.above) m.add(o.x[j], o.y[j], o.z[j]);
  }
  return fitPlane(m);
}

OwnWall fitOwnWall(const Offsets& o, const Plane& start, float most_apart) {
  OwnWall own{start, {}};
  for (int round = 0; round < 2; ++round) {
    own.split = splitWalls(o, own.plane.normal, most_apart);
    if (!own.split.found) break;
    Plane refined = fitWithin(o, own.plane.normal, own.split);
    if (!refined.valid) break;
    // What is above stays above.
    if (refined.normal.dot(own.plane.normal) < 0.F) refined.normal = -refined.normal;
    own.plane = refined;
  }
  return own;
}

}  // namespace segorient::detail
