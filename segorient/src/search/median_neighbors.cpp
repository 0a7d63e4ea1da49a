// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/search/median_hash_index.h>
#include <segorient/search/impl/median_neighbors.hpp>

#include <algorithm>
#include <vector>

#include "common/compact_cloud.h"

namespace segorient::search {

int medianNeighborsWithin(const PointView& points, double radius, int threads) {
  // Along a space-filling curve, equal steps reach all parts of the cloud.
  const CompactCloud cloud = compactCloud(points, nullptr, threads);
  if (cloud.size() == 0) return 0;
  MedianHashIndex index;
  MedianHashIndex::Options options;
  options.threads = threads;
  index.build(cloud.view(), nullptr, options);
  constexpr std::size_t kSample = 2000;  // the median of their counts is off by 1 % or so
  const std::size_t count = std::min(kSample, cloud.size());
  std::vector<int> found;
  std::vector<pcl::index_t> indices;
  std::vector<float> distances;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = i * cloud.size() / count;
    // The point itself is one of them, whatever the radius.
    const int within = index.radius(cloud.view()[row], radius, indices, distances,
                                    kMostNeighborsWithin + 1, false);
    found.push_back(std::max(within - 1, 0));
  }
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  return *middle;
}

}  // namespace segorient::search
