// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/point_view.h>

#include <algorithm>
#include <vector>

namespace segorient::test {

struct Neighbor {
  float distance;
  pcl::index_t index;
  bool operator<(const Neighbor& o) const {
    return distance < o.distance || (distance == o.distance && index < o.index);
  }
  bool operator==(const Neighbor& o) const { return distance == o.distance && index == o.index; }
};

/// All points by (squared distance in float, index), the oracle for every search.
/// \param indices points to search, or null for all; invalid ones are left out
inline std::vector<Neighbor> bruteForce(const PointView& points, const float* query,
                                        const std::vector<pcl::index_t>* indices = nullptr) {
  std::vector<Neighbor> found;
  const std::size_t rows = indices != nullptr ? indices->size() : points.size;
  for (std::size_t i = 0; i < rows; ++i) {
    const auto index = indices != nullptr ? (*indices)[i] : static_cast<pcl::index_t>(i);
    if (index < 0 || static_cast<std::size_t>(index) >= points.size) continue;
    const float* p = points[static_cast<std::size_t>(index)];
    if (!isFinite(p)) continue;
    // volatile: one rounding an operation, whatever the compiler's flags
    volatile float sum = 0.0F;
    for (int a = 0; a < 3; ++a) {
      volatile float d = query[a] - p[a];
      volatile float square = d * d;
      sum = sum + square;
    }
    found.push_back({sum, index});
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The row that an all-points search owes to point `self`: itself first, the others as
/// bruteForce().
inline std::vector<Neighbor> bruteForceRow(const PointView& points, pcl::index_t self,
                                           std::size_t k,
                                           const std::vector<pcl::index_t>* indices = nullptr) {
  auto found = bruteForce(points, points[static_cast<std::size_t>(self)], indices);
  const auto own =
      std::find_if(found.begin(), found.end(), [&](const Neighbor& n) { return n.index == self; });
  std::rotate(found.begin(), own, own + 1);
  found.resize(std::min(k, found.size()));
  return found;
}

/// Row i of a table of neighbours, of Neighborhoods or RadiusNeighborhoods.
template <typename Table>
std::vector<Neighbor> row(const Table& table, std::size_t i) {
  std::vector<Neighbor> result;
  for (std::size_t j = 0; j < static_cast<std::size_t>(table.count(i)); ++j) {
    result.push_back({table.sqrDistances(i)[j], table.indices(i)[j]});
  }
  return result;
}

}  // namespace segorient::test
