// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/shares.h"

#include <cstddef>

namespace segorient::detail {

std::vector<std::int32_t> strongestPlaces(const DensityPatches& patches,
                                          const std::vector<std::array<double, 3>>& places,
                                          const std::vector<std::vector<float>>& rows) {
  std::vector<std::vector<float>> heights;
  for (const std::array<double, 3>& place : places) heights.push_back(patches.heightsOver(place));
  std::vector<std::int32_t> out(patches.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i) {
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
    out[i] = sum[1] > sum[0] ? best[1] : best[0];
  }
  return out;
}

}  // namespace segorient::detail
