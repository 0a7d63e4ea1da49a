// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/impl/fast_vector.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// The k nearest neighbours of every point, in one flat table: what all stages share, so that
/// neighbours are found once (paper, section 2.1).
///
/// Row i belongs to point i of the cloud that was searched (or to its i-th index, where indices
/// were given). A row is ascending by distance, ties by index, and begins with the point itself at
/// distance 0, as in PCL. A stage that needs fewer neighbours reads a prefix of each row. Rows of
/// points with NaN or infinite coordinates are empty.
///
/// Memory: k * (sizeof(pcl::index_t) + 4) bytes a row, or k * sizeof(pcl::index_t) without
/// distances.
class Neighborhoods {
 public:
  /// Makes room for `rows` rows of at most `k` entries; every row is empty afterwards.
  /// \param with_distances false saves 4 bytes an entry; sqrDistances() is then null
  void reset(std::size_t rows, int k, bool with_distances = true) {
    makeRoom(rows, k, with_distances);
    counts_.assign(rows_, 0);
  }

  /// The same where the search is going to fill all rows with `count` entries: it saves 4 bytes a
  /// row until setCount() is called.
  void resetFull(std::size_t rows, int k, int count, bool with_distances = true) {
    makeRoom(rows, k, with_distances);
    counts_.clear();
    count_ = count;
  }

  std::size_t size() const { return rows_; }  ///< number of rows
  int k() const { return k_; }                ///< room in each row
  bool hasDistances() const { return !distances_.empty(); }

  /// Entries in a row; less than k() only where there are fewer points.
  int count(std::size_t row) const {
    return counts_.empty() ? count_ : static_cast<int>(counts_[row]);
  }

  /// The row's neighbours, indices into the cloud.
  const pcl::index_t* indices(std::size_t row) const {
    return indices_.data() + row * static_cast<std::size_t>(k_);
  }

  /// The row's squared distances, or null in a table without distances.
  const float* sqrDistances(std::size_t row) const {
    return distances_.empty() ? nullptr : distances_.data() + row * static_cast<std::size_t>(k_);
  }

  /// For the search that fills the table; each row from a thread of its own, but setCount() after
  /// resetFull() from one thread at a time.
  pcl::index_t* mutableIndices(std::size_t row) {
    return indices_.data() + row * static_cast<std::size_t>(k_);
  }
  float* mutableSqrDistances(std::size_t row) {
    return distances_.empty() ? nullptr : distances_.data() + row * static_cast<std::size_t>(k_);
  }
  void setCount(std::size_t row, int count) {
    if (counts_.empty()) counts_.assign(rows_, static_cast<std::uint32_t>(count_));
    counts_[row] = static_cast<std::uint32_t>(count);
  }

  /// Bytes in use.
  std::size_t memory() const {
    return indices_.capacity() * sizeof(pcl::index_t) + distances_.capacity() * sizeof(float) +
           counts_.capacity() * sizeof(std::uint32_t);
  }

 private:
  void makeRoom(std::size_t rows, int k, bool with_distances) {
    rows_ = rows;
    k_ = k < 0 ? 0 : k;
    const std::size_t entries = rows_ * static_cast<std::size_t>(k_);
    indices_.resize(entries);
    distances_.resize(with_distances ? entries : 0);
  }

  std::size_t rows_ = 0;
  int k_ = 0;
  int count_ = 0;  ///< of every row, where `counts_` is empty
  FastVector<pcl::index_t> indices_;
  FastVector<float> distances_;
  std::vector<std::uint32_t> counts_;
};

/// The neighbours within a radius of every point: rows of different lengths, count(i), indices(i)
/// and sqrDistances(i) of point i, ordered as in Neighborhoods.
///
/// Rows do not lie one after another: each region of the search has a part of its own, as nobody
/// knows how long the rows of others will be. They stay where they are until the table is filled
/// again.
///
/// Memory: 16 bytes a row and sizeof(pcl::index_t) + 4 bytes a neighbour, or sizeof(pcl::index_t)
/// without distances. There is more room than that, which nothing is written to: a part has a
/// quarter more than the rows of the region before it took, and 1024 entries at least. memory()
/// counts it, so it depends on the number of threads. A table that is filled again keeps the room
/// it has, until it is destroyed.
class RadiusNeighborhoods {
 public:
  /// Rows one after another. Whoever fills it may make the arrays longer than `used`.
  struct Part {
    FastVector<pcl::index_t> indices;
    FastVector<float> distances;  ///< empty in a table without distances
    std::size_t used = 0;         ///< entries
  };

  std::size_t size() const { return rows_.size(); }                      ///< number of rows
  bool hasDistances() const { return with_distances_; }                  ///< see sqrDistances()
  std::size_t count(std::size_t row) const { return rows_[row].count; }  ///< entries in a row

  /// Entries of all rows together.
  std::size_t entries() const {
    std::size_t sum = 0;
    for (const Part& part : parts_) sum += part.used;
    return sum;
  }

  /// The row's neighbours, indices into the cloud.
  const pcl::index_t* indices(std::size_t row) const {
    return parts_[rows_[row].part].indices.data() + rows_[row].begin;
  }

  /// The row's squared distances, or null in a table without distances.
  const float* sqrDistances(std::size_t row) const {
    return with_distances_ ? parts_[rows_[row].part].distances.data() + rows_[row].begin : nullptr;
  }

  // What follows is for the search that fills the table.

  /// Every row is empty afterwards. Different threads may fill different parts, and set the rows in
  /// them, at a time.
  void reset(std::size_t rows, std::size_t parts, bool with_distances = true) {
    with_distances_ = with_distances;
    rows_.assign(rows, Row{});
    parts_.resize(parts > 0 ? parts : 1);
    for (Part& part : parts_) {
      part.used = 0;
      if (!with_distances) part.distances = {};
    }
  }
  Part& part(std::size_t i) { return parts_[i]; }
  void setRow(std::size_t row, std::size_t part, std::size_t begin, std::size_t count) {
    rows_[row] = {begin, static_cast<std::uint32_t>(part), static_cast<std::uint32_t>(count)};
  }

  /// Bytes in use.
  std::size_t memory() const {
    std::size_t sum = rows_.capacity() * sizeof(Row) + parts_.capacity() * sizeof(Part);
    for (const Part& part : parts_) {
      sum += part.indices.capacity() * sizeof(pcl::index_t);
      sum += part.distances.capacity() * sizeof(float);
    }
    return sum;
  }

 private:
  struct Row {
    std::size_t begin = 0;
    std::uint32_t part = 0;
    std::uint32_t count = 0;
  };
  bool with_distances_ = true;
  std::vector<Row> rows_;
  std::vector<Part> parts_;
};

}  // namespace segorient
