// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/bulk_bounds.h"

namespace segorient {

Bounds fenceAround(std::array<std::vector<double>, 3>& coordinates) {
  constexpr double kWidths = 16.0;
  const std::size_t count = coordinates[0].size();
  std::array<double, 3> medians{0.0, 0.0, 0.0};
  double width = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<double>& values = coordinates[a];
    const auto rank = [&](std::size_t quarters) {
      const auto at =
          values.begin() + static_cast<std::ptrdiff_t>(std::min(count * quarters / 4, count - 1));
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    medians[a] = rank(2);
    width = std::max(width, rank(3) - rank(1));
  }
  if (!(width > 0.0)) width = std::numeric_limits<double>::infinity();
  Bounds fence;
  for (std::size_t a = 0; a < 3; ++a) {
    fence.low[a] = medians[a] - kWidths * width;
    fence.high[a] = medians[a] + kWidths * width;
  }
  return fence;
}

}  // namespace segorient
