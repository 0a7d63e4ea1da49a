// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/seen_from.h"

#include <algorithm>
#include <cmath>

#include "common/parallel_for.h"
#include "search/index_of.h"

namespace segorient::detail {

search::MedianHashIndex SeenFrom::index(int threads) const {
  return search::indexOf({direction.data(), 4, size()}, threads);
}

SeenFrom seeFrom(const std::array<float, 3>& place, const PointView& points, int threads) {
  constexpr double kPointTime = 20.0;  // ns, see resolveThreads()
  SeenFrom out;
  out.direction.assign(4 * points.size, 0.F);
  out.distance.assign(points.size, 0.F);
  parallelFor(points.size, threads, kPointTime, [&](std::size_t i) {
    double v[3];
    double square = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      v[a] = static_cast<double>(points[i][a]) - static_cast<double>(place[a]);
      square += v[a] * v[a];
    }
    const double d = std::sqrt(square);
    out.distance[i] = static_cast<float>(d);
    for (std::size_t a = 0; a < 3 && d > 0.0; ++a) {
      out.direction[4 * i + a] = static_cast<float>(v[a] / d);
    }
  });
  if (points.size > 0) {
    const auto [least, most] = std::minmax_element(out.distance.begin(), out.distance.end());
    out.depth = *most - *least;
  }
  return out;
}

}  // namespace segorient::detail
