// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/parallel_for.h"

namespace segorient::search {

/// The index of all of some points.
inline MedianHashIndex indexOf(const PointView& points, int threads) {
  MedianHashIndex out;
  MedianHashIndex::Options options;
  options.threads = threads;
  out.build(points, nullptr, options);
  return out;
}

/// The nearest of the indexed points; below 0 where there is none.
struct Nearest {
  pcl::index_t point = -1;
  float square = 0.F;  ///< of the distance

  Nearest(const MedianHashIndex& index, const float* place) {
    if (index.nearestK(place, 1, &point, &square) < 1) point = -1;
  }
};

/// The same of each of some points.
inline std::vector<std::int32_t> nearestOf(const MedianHashIndex& index, const PointView& points,
                                           int threads) {
  constexpr double kQueryTime = 300.0;  // ns, see resolveThreads()
  std::vector<std::int32_t> out(points.size);
  parallelFor(points.size, threads, kQueryTime, [&](std::size_t i) {
    out[i] = static_cast<std::int32_t>(Nearest(index, points[i]).point);
  });
  return out;
}

}  // namespace segorient::search
