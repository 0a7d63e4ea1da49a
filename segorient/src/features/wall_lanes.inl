// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// splitWalls() for several points, one a lane, for one instruction set; see lanes.inl.

#include "common/lanes.inl"

#include "features/sorting_lanes.inl"

/// Offsets of a point and its neighbours along its normal, in spacings.
inline void loadOffsets(const WallRows& of, std::size_t at, Lanes* offsets) {
  const Lanes3 own = loadPoints(&of.own[at]);
  const Lanes3 normal{load(&of.normal_x[at]), load(&of.normal_y[at]), load(&of.normal_z[at])};
  const Lanes per_spacing = load(&of.per_spacing[at]);
  offsets[0] = Lanes{};
  for (std::size_t j = 1; j < kWallEntries; ++j) {
    const float* points[kWidth];
    for (std::size_t l = 0; l < kWidth; ++l) {
      points[l] = of.xyz + 4 * static_cast<std::size_t>(of.rows[at + l][j]);
    }
    offsets[j] = dot(scaled(difference(loadPoints(points), own), per_spacing), normal);
  }
}

inline Mask twoWalls(const WallRows& of, std::size_t at) {
  Lanes t[kWallEntries];
  loadOffsets(of, at, t);
  sortLanes<kWallEntries>(t);
  Lanes left[kWallEntries];  // sums up to each
  Lanes sum{};
  Lanes squares{};
  for (std::size_t j = 0; j < kWallEntries; ++j) {
    sum = sum + t[j];
    squares = squares + t[j] * t[j];
    left[j] = sum;
  }
  constexpr auto kCount = static_cast<float>(kWallEntries);
  const Lanes total = squares - sum * sum / kCount;
  Lanes between = all(-1.F);
  Lanes apart{};
  Lanes gap{};
  for (std::size_t j = kLeastOfWall - 1; j < kWallEntries - kLeastOfWall; ++j) {
    const auto a = static_cast<float>(static_cast<int>(j) + 1);
    const float b = kCount - a;
    const Lanes between_means = (sum - left[j]) / b - left[j] / a;
    const Lanes value = a * b / kCount * between_means * between_means;
    const Mask best = value > between;
    between = select(best, value, between);
    apart = select(best, between_means, apart);
    gap = select(best, t[j + 1] - t[j], gap);
  }
  return (total > 0.F) & (apart <= of.most_apart) & (apart > kLeastApart) &
         (total - between < kWithin * total) & (gap > kEmpty * apart);
}

/// Bit l: point l sees two walls.
std::uint32_t findTwoWalls(const WallRows& of) {
  std::uint32_t found = 0;
  for (std::size_t at = 0; at < WallRows::kRows; at += kWidth) {
    const Mask here = twoWalls(of, at);
    for (std::size_t l = 0; l < kWidth && any(here); ++l) {
      found |= (static_cast<std::uint32_t>(here[l]) & 1U) << (at + l);
    }
  }
  return found;
}
