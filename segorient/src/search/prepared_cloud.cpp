// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "search/prepared_cloud.h"

#include <utility>

#include "common/searched_neighborhoods.h"
#include "search/index_of.h"

namespace segorient {

namespace {

// The rows of a cloud that some indices name, each once, ascending.
pcl::Indices chosenRows(const pcl::Indices& indices, std::size_t rows) {
  std::vector<bool> chosen(rows, false);
  for (const pcl::index_t i : indices) {
    if (i >= 0 && static_cast<std::size_t>(i) < rows) chosen[static_cast<std::size_t>(i)] = true;
  }
  pcl::Indices out;
  for (std::size_t row = 0; row < rows; ++row) {
    if (chosen[row]) out.push_back(static_cast<pcl::index_t>(row));
  }
  return out;
}

CompactCloud compactChosen(const PointView& points, const pcl::Indices& indices, int threads,
                           const Bounds* frame) {
  const pcl::Indices chosen = chosenRows(indices, points.size);
  CompactCloud out = compactCloud(points, &chosen, threads, frame);
  std::vector<pcl::index_t> row_of(points.size, -1);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    row_of[static_cast<std::size_t>(chosen[i])] = out.row_of[i];
  }
  out.row_of = std::move(row_of);
  for (pcl::index_t& row : out.source) row = chosen[static_cast<std::size_t>(row)];
  return out;
}

}  // namespace

PreparedCloud::PreparedCloud(const PointView& points, const pcl::Indices* indices, int threads,
                             const Bounds* frame)
    : cloud_(indices != nullptr ? compactChosen(points, *indices, threads, frame)
                                : compactCloud(points, nullptr, threads, frame)),
      threads_(threads) {
  normalizeUnit(cloud_);
}

std::size_t PreparedCloud::withoutPoint() const {
  return static_cast<std::size_t>(
      std::count(cloud_.row_of.begin(), cloud_.row_of.end(), pcl::index_t{-1}));
}

std::size_t PreparedCloud::duplicates() const {
  return rows() - withoutPoint() - size();
}

const search::MedianHashIndex& PreparedCloud::index() {
  if (!indexed_) {
    index_ = search::indexOf(points(), threads_);
    indexed_ = true;
  }
  return index_;
}

void PreparedCloud::dropIndex() {
  takeIndex();
}

search::MedianHashIndex PreparedCloud::takeIndex() {
  indexed_ = false;
  return std::exchange(index_, search::MedianHashIndex());
}

int PreparedCloud::findNeighbors(int k, bool with_distances) {
  // More than there are would only cost memory.
  const std::size_t others = size() > 0 ? size() - 1 : 0;
  const int most = static_cast<int>(std::min(static_cast<std::size_t>(std::max(k, 0)), others));
  index().nearestKAll(most + 1, table_, with_distances);
  return most;
}

int PreparedCloud::findNeighbors(int k, const PointSearch& search) {
  if (!search) return findNeighbors(k);
  const std::size_t others = size() > 0 ? size() - 1 : 0;
  const int most = static_cast<int>(std::min(static_cast<std::size_t>(std::max(k, 0)), others));
  searchNeighborhoods(cloud_, search, most + 1, table_);
  return most;
}

}  // namespace segorient
