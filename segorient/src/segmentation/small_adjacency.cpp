// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/small_adjacency.h"

namespace segorient::segmentation {

SmallAdjacency::SmallAdjacency(const GrowthState& state, std::size_t small_size)
    : state_(state),
      slots_(state.nodes.size()),
      heads_(state.clusters.size(), kNone),
      tails_(state.clusters.size(), kNone),
      stamps_(state.nodes.size()) {
  std::vector<std::uint8_t> is_small;
  is_small.reserve(state.clusters.size());
  for (std::size_t s = 0; s < state.clusters.size(); ++s)
    is_small.push_back(state.isFace(static_cast<std::int32_t>(s), small_size) ? 0 : 1);
  for (std::size_t p = 0; p < state.nodes.size(); ++p) {
    const std::int32_t label = state.labels[p];
    if (label < 0 || is_small[static_cast<std::size_t>(label)] == 0) continue;
    const auto slot = static_cast<std::uint32_t>(points_.size());
    slots_[p] = slot + 1;
    points_.push_back(static_cast<pcl::index_t>(p));
    next_.push_back(kNone);
    const auto segment = static_cast<std::size_t>(label);
    if (heads_[segment] == kNone) {
      heads_[segment] = slot;
    } else {
      next_[tails_[segment]] = slot;
    }
    tails_[segment] = slot;
  }
  listReverse();
}

// Only points on a border can have a neighbour in another segment, and only those of other segments
// are of interest: a segment's own points do not count as neighbours of it.
void SmallAdjacency::listReverse() {
  reverse_starts_.assign(points_.size() + 1, 0);
  if (points_.empty()) return;
  const std::int32_t* labels = state_.labels.data();
  const auto visitReverse = [&](std::size_t p, auto&& visit) {
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int count = state_.rowSize(p);
    bool any = false;
    for (int j = 1; j < count; ++j) {
      const std::uint32_t slot = this->slot(static_cast<std::size_t>(row[j]));
      if (slot == kNone || labels[row[j]] == labels[p]) continue;
      visit(slot);
      any = true;
    }
    return any;
  };
  std::vector<pcl::index_t> sources;
  for (const pcl::index_t p : state_.border) {
    if (visitReverse(static_cast<std::size_t>(p),
                     [&](std::uint32_t slot) { ++reverse_starts_[slot + 1]; })) {
      sources.push_back(p);
    }
  }
  for (std::size_t s = 0; s < points_.size(); ++s) reverse_starts_[s + 1] += reverse_starts_[s];
  reverse_.resize(reverse_starts_.back());
  std::vector<std::size_t> next(reverse_starts_.begin(), reverse_starts_.end() - 1);
  for (const pcl::index_t p : sources) {
    visitReverse(static_cast<std::size_t>(p),
                 [&](std::uint32_t slot) { reverse_[next[slot]++] = p; });
  }
}

void SmallAdjacency::append(std::int32_t from, std::int32_t into) {
  const auto a = static_cast<std::size_t>(from);
  const auto b = static_cast<std::size_t>(into);
  if (heads_[b] != kNone) {
    next_[tails_[b]] = heads_[a];
    tails_[b] = tails_[a];
  }
  heads_[a] = kNone;
  tails_[a] = kNone;
}

}  // namespace segorient::segmentation
