// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/searched_neighborhoods.h"

#include <algorithm>
#include <cstddef>

namespace segorient {
namespace {

struct Neighbor {
  float squared;
  pcl::index_t row;
};

bool operator<(const Neighbor& l, const Neighbor& r) {
  return l.squared != r.squared ? l.squared < r.squared : l.row < r.row;
}

float squaredDistance(const float* p, const float* q) {
  const float x = p[0] - q[0];
  const float y = p[1] - q[1];
  const float z = p[2] - q[2];
  return x * x + y * y + z * z;
}

}  // namespace

void makeRoomForSearch(int k, pcl::Indices& indices, std::vector<float>& sqr_distances) {
  const auto room = static_cast<std::size_t>(std::max(k, 0));
  indices.assign(room, 0);
  sqr_distances.assign(room, 0.F);
}

int keepFound(int count, pcl::Indices& indices, std::vector<float>& sqr_distances) {
  const auto found = static_cast<std::size_t>(std::max(count, 0));
  indices.resize(std::min(found, indices.size()));
  sqr_distances.resize(indices.size(), 0.F);
  return static_cast<int>(indices.size());
}

void searchNeighborhoods(const CompactCloud& cloud, const PointSearch& search, int k,
                         Neighborhoods& out) {
  out.reset(cloud.size(), k);
  if (k < 1) return;
  const PointView points = cloud.view();
  pcl::Indices found;
  std::vector<float> distances;
  std::vector<Neighbor> neighbors;
  const auto wanted = static_cast<int>(std::min(static_cast<std::size_t>(k), cloud.row_of.size()));
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    makeRoomForSearch(wanted, found, distances);
    keepFound(search(cloud.source[row], wanted, found, distances), found, distances);
    neighbors.clear();
    for (const pcl::index_t point : found) {
      if (point < 0 || static_cast<std::size_t>(point) >= cloud.row_of.size()) continue;
      const pcl::index_t other = cloud.row_of[static_cast<std::size_t>(point)];
      if (other < 0 || static_cast<std::size_t>(other) == row) continue;
      neighbors.push_back(
          {squaredDistance(points[row], points[static_cast<std::size_t>(other)]), other});
    }
    std::sort(neighbors.begin(), neighbors.end());
    const auto same = [](const Neighbor& l, const Neighbor& r) { return l.row == r.row; };
    neighbors.erase(std::unique(neighbors.begin(), neighbors.end(), same), neighbors.end());
    const auto count = std::min(neighbors.size(), static_cast<std::size_t>(k) - 1);
    pcl::index_t* indices = out.mutableIndices(row);
    float* squared = out.mutableSqrDistances(row);
    indices[0] = static_cast<pcl::index_t>(row);
    squared[0] = 0.F;
    for (std::size_t j = 0; j < count; ++j) {
      indices[j + 1] = neighbors[j].row;
      squared[j + 1] = neighbors[j].squared;
    }
    out.setCount(row, static_cast<int>(count) + 1);
  }
}

}  // namespace segorient
