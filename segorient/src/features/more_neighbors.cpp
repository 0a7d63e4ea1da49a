// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/more_neighbors.h"

#include <algorithm>

namespace segorient::detail {

void MoreNeighbors::build() {
  if (indexed_) return;
  search::MedianHashIndex::Options options;
  options.threads = threads_;
  index_.build(points_, nullptr, options);
  indexed_ = true;
}

const Neighborhoods& MoreNeighbors::ofAll() {
  if (hasAll()) return all_;
  build();
  index_.nearestKAll(kCount + 1, all_, false);
  index_ = {};
  indexed_ = false;
  return all_;
}

void MoreNeighbors::prepareRows() {
  if (!hasAll()) build();
}

MoreNeighbors::Row MoreNeighbors::row(std::size_t i, int entries, Room& room) const {
  if (hasAll()) return {all_.indices(i), std::min(all_.count(i), entries)};
  std::array<float, kCount + 1> squares;
  return {room.data(), index_.nearestK(points_[i], entries, room.data(), squares.data(), 0.F)};
}

}  // namespace segorient::detail
