// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_walls.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace segorient::detail {

WallSplit splitWalls(const Offsets& o, const Eigen::Vector3f& normal, float most_apart) {
  constexpr std::size_t kLeast = 4;  // fewer points have no plane with a residual
  std::array<float, kSheetNeighbors + 1> t;
  const auto n = static_cast<std::size_t>(o.n) + 1;
  WallSplit split;
  // In spacings: nearer than that, offsets of neighbours do not fall into two groups.
  constexpr float kLeastApart = 0.35F;
  if (n < 2 * kLeast) return split;
  t[0] = 0.F;
  float lowest = 0.F;
  float highest = 0.F;
  for (std::size_t j = 1; j < n; ++j) {
    t[j] = o.along(j - 1, normal);
    lowest = std::min(lowest, t[j]);
    highest = std::max(highest, t[j]);
  }
  if (highest - lowest <= kLeastApart) return split;
  std::sort(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(n));
  float sum = 0.F;
  float squares = 0.F;
  for (std::size_t j = 0; j < n; ++j) {
    sum += t[j];
    squares += t[j] * t[j];
  }
  const auto count = static_cast<float>(n);
  const float total = squares - sum * sum / count;
  if (!(total > 0.F)) return split;

  float left = 0.F;
  float between = -1.F;
  float apart = 0.F;
  std::size_t at = 0;
  for (std::size_t j = 0; j + kLeast < n; ++j) {
    left += t[j];
    if (j + 1 < kLeast) continue;
    const auto a = static_cast<float>(j + 1);
    const float b = count - a;
    const float gap = (sum - left) / b - left / a;
    const float value = a * b / count * gap * gap;
    if (value > between) {
      between = value;
      apart = gap;
      at = j;
    }
  }
  const float low = t[at];
  const float high = t[at + 1];
  if (apart > most_apart) return split;
  // Two classes, each thin, well apart, with nothing in between: two walls.
  if (total - between >= 0.2F * total || apart <= kLeastApart || high - low <= 0.15F * apart)
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
