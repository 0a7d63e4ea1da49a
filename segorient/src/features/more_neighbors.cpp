// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/more_neighbors.h"

#include <array>

namespace segorient::detail {

const search::MedianHashIndex& MoreNeighbors::index() {
  if (!indexed_) {
    search::MedianHashIndex::Options options;
    options.threads = threads_;
    index_.build(points_, nullptr, options);
    indexed_ = true;
  }
  return index_;
}

int MoreNeighbors::nearest(std::size_t i, int entries, pcl::index_t* row) const {
  std::array<float, kMost + 1> squares;
  return index_.nearestK(points_[i], entries, row, squares.data(), 0.F);
}

}  // namespace segorient::detail
