// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/segment_clusters.h"

#include "common/at.h"

namespace segorient::detail {
SegmentClusters::SegmentClusters(const Segmentation& segmentation,
                                 const std::vector<BorderVote>& votes, bool contract_certain,
                                 std::size_t points) {
  const std::size_t n = segmentation.segments.size();
  std::vector<std::uint32_t> sizes(n);
  for (std::size_t s = 0; s < n; ++s) sizes[s] = segmentation.segments[s].size;
  ClusterGraph graph(sizes, votes);
  if (contract_certain) {
    ClusterGraph::Rule certain;
    certain.unanimity = 0.9F;
    certain.weight = 4.F;  // a border of a few points
    certain.reliable = 0.5F;
    // Where next to all of a longer border agree, that makes up for fewer sure normals, as they are
    // in sparse stripes of a clean cloud.
    ClusterGraph::Rule unanimous;
    unanimous.unanimity = 0.97F;
    unanimous.weight = 4.F * certain.weight;
    unanimous.reliable = 0.5F * certain.reliable;
    graph.contract({certain, unanimous});
    // Two large clusters are joined only with all evidence on the table.
    ClusterGraph::Rule likely;
    likely.unanimity = 0.6F;
    likely.both_larger = static_cast<std::uint32_t>(points / 50);
    graph.contract({likely});
  }
  of_.resize(n);
  inside_.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    int sign = 1;
    of_[s] = graph.find(static_cast<std::int32_t>(s), sign);
    inside_[s] = static_cast<std::int8_t>(sign);
  }
  graph.contract({ClusterGraph::Rule{}});
  sign_.assign(n, 1);
  root_.assign(n, -1);
  for (std::size_t s = 0; s < n; ++s) {
    int sign = 1;
    root_[at(of_[s])] = graph.find(of_[s], sign);
    sign_[at(of_[s])] = static_cast<std::int8_t>(sign);
  }
}

}  // namespace segorient::detail
