// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Clouds that were thinned after they were seen.
#pragma once

#include <segorient/common/point_view.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

namespace segorient::test {

/// As pcl::VoxelGrid does it: the mean of the points of each cell.
/// \return 4 floats a point
inline std::vector<float> thinned(const PointView& points, double edge) {
  struct Sum {
    std::array<double, 3> xyz{0.0, 0.0, 0.0};
    double count = 0.0;
  };
  std::map<std::array<long, 3>, Sum> cells;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!std::isfinite(points[i][0])) continue;
    std::array<long, 3> cell{};
    for (std::size_t a = 0; a < 3; ++a) {
      cell[a] = std::lround(std::floor(static_cast<double>(points[i][a]) / edge));
    }
    Sum& sum = cells[cell];
    for (std::size_t a = 0; a < 3; ++a) sum.xyz[a] += static_cast<double>(points[i][a]);
    sum.count += 1.0;
  }
  std::vector<float> out;
  for (const auto& [cell, sum] : cells) {
    for (const double v : sum.xyz) out.push_back(static_cast<float>(v / sum.count));
    out.push_back(0.F);
  }
  return out;
}

}  // namespace segorient::test
