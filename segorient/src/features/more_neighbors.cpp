// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/more_neighbors.h"

#include <array>
#include <vector>

#include "common/parallel_for.h"
#include "search/index_of.h"

namespace segorient::detail {

Neighborhoods nearestOfPlaces(const search::MedianHashIndex& index, const PointView& places,
                              int entries, int threads) {
  constexpr double kQueryTime = 2000.0;  // ns, see resolveThreads()
  Neighborhoods table;
  table.reset(places.size, entries, false);
  parallelFor(
      places.size, threads, kQueryTime,
      [&] { return std::vector<float>(static_cast<std::size_t>(entries)); },
      [&](std::size_t i, std::vector<float>& squares) {
        table.setCount(
            i, index.nearestK(places[i], entries, table.mutableIndices(i), squares.data(), 0.F));
      });
  return table;
}

const search::MedianHashIndex& MoreNeighbors::index() {
  if (!indexed_) {
    index_ = search::indexOf(points_, threads_);
    indexed_ = true;
  }
  asked_ = true;
  return index_;
}

void MoreNeighbors::dropUnasked() {
  if (asked_) return;
  index_ = search::MedianHashIndex();
  indexed_ = false;
}

int MoreNeighbors::nearest(std::size_t i, int entries, pcl::index_t* row) const {
  std::array<float, kMost + 1> squares;
  return index_.nearestK(points_[i], entries, row, squares.data(), 0.F);
}

}  // namespace segorient::detail
