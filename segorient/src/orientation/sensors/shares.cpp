// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/shares.h"

#include <algorithm>
#include <cstddef>

namespace segorient::detail {
namespace {

// What one side leaves beside the other to be sure of it. Sums of what a few places leave are off
// by a factor of two, as far as their deviations tell: the two of them by four.
constexpr float kOneSided = 4.F;

}  // namespace

PieceOrigins strongestPlaces(const DensityPatches& patches,
                             const std::vector<std::array<double, 3>>& places,
                             const std::vector<std::vector<float>>& rows) {
  std::vector<std::vector<float>> heights;
  for (const std::array<double, 3>& place : places) heights.push_back(patches.heightsOver(place));
  PieceOrigins out;
  out.place.assign(patches.size(), 0);
  out.either_side.assign(patches.size(), 0);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    float sum[2] = {0.F, 0.F};
    float most[2] = {-1.F, -1.F};
    std::int32_t best[2] = {0, 0};
    for (std::size_t j = 0; j < places.size(); ++j) {
      const std::size_t side = heights[j][i] > 0.F ? 1 : 0;
      sum[side] += rows[j][i];
      if (rows[j][i] <= most[side]) continue;
      most[side] = rows[j][i];
      best[side] = static_cast<std::int32_t>(j);
    }
    out.place[i] = sum[1] > sum[0] ? best[1] : best[0];
    const auto [less, more] = std::minmax(sum[0], sum[1]);
    out.either_side[i] = more < kOneSided * less ? 1 : 0;
  }
  return out;
}

}  // namespace segorient::detail
