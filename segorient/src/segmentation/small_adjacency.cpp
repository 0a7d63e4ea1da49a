// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/small_adjacency.h"

#include <atomic>

namespace segorient::segmentation {

SmallAdjacency::SmallAdjacency(const GrowthState& state, std::size_t small_size, int threads)
    : state_(state),
      slots_(state.nodes.size()),
      heads_(state.clusters.size(), kNone),
      tails_(state.clusters.size(), kNone) {
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
  listReverse(threads);
}

// Only points on a border can have a neighbour in another segment, and only those of other segments
// are of interest: a segment's own points do not count as neighbours of it.
void SmallAdjacency::listReverse(int threads) {
  constexpr double kRowTime = 100.0;  // ns, see resolveThreads()
  reverse_starts_.assign(points_.size() + 1, 0);
  if (points_.empty()) return;
  const std::int32_t* labels = state_.labels.data();
  const auto visitReverse = [&](std::size_t p, auto&& visit) {
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int count = state_.rowSize(p);
    for (int j = 1; j < count; ++j) {
      const std::uint32_t slot = this->slot(static_cast<std::size_t>(row[j]));
      if (slot != kNone && labels[row[j]] != labels[p]) visit(slot);
    }
  };
  const std::unique_ptr<std::atomic<std::uint32_t>[]> left(
      new std::atomic<std::uint32_t>[points_.size()] {});
  const auto forEachBorder = [&](auto&& work) {
    parallelFor(state_.border.size(), threads, kRowTime,
                [&](std::size_t b) { work(state_.border[b]); });
  };
  forEachBorder([&](pcl::index_t p) {
    visitReverse(static_cast<std::size_t>(p),
                 [&](std::uint32_t slot) { left[slot].fetch_add(1, std::memory_order_relaxed); });
  });
  for (std::size_t s = 0; s < points_.size(); ++s) {
    reverse_starts_[s + 1] = reverse_starts_[s] + left[s];
  }
  reverse_.resize(reverse_starts_.back());
  forEachBorder([&](pcl::index_t p) {
    visitReverse(static_cast<std::size_t>(p), [&](std::uint32_t slot) {
      const std::uint32_t at = left[slot].fetch_sub(1, std::memory_order_relaxed) - 1;
      reverse_[reverse_starts_[slot] + at] = p;
    });
  });
  // Whichever thread was first.
  parallelFor(points_.size(), threads, kRowTime, [&](std::size_t s) {
    const auto at = [&](std::size_t i) {
      return reverse_.begin() + static_cast<std::ptrdiff_t>(reverse_starts_[i]);
    };
    std::sort(at(s), at(s + 1));
  });
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
