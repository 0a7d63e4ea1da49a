// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/fast_vector.h>

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
    rows_ = rows;
    k_ = k < 0 ? 0 : k;
    const std::size_t entries = rows_ * static_cast<std::size_t>(k_);
    indices_.resize(entries);
    distances_.resize(with_distances ? entries : 0);
    counts_.assign(rows_, 0);
  }

  std::size_t size() const { return rows_; }  ///< number of rows
  int k() const { return k_; }                ///< room in each row
  bool hasDistances() const { return !distances_.empty(); }

  /// Entries in a row; less than k() only where there are fewer points.
  int count(std::size_t row) const { return static_cast<int>(counts_[row]); }

  /// The row's neighbours, indices into the cloud.
  const pcl::index_t* indices(std::size_t row) const {
    return indices_.data() + row * static_cast<std::size_t>(k_);
  }

  /// The row's squared distances, or null in a table without distances.
  const float* sqrDistances(std::size_t row) const {
    return distances_.empty() ? nullptr : distances_.data() + row * static_cast<std::size_t>(k_);
  }

  /// For the search that fills the table.
  pcl::index_t* mutableIndices(std::size_t row) {
    return indices_.data() + row * static_cast<std::size_t>(k_);
  }
  float* mutableSqrDistances(std::size_t row) {
    return distances_.empty() ? nullptr : distances_.data() + row * static_cast<std::size_t>(k_);
  }
  void setCount(std::size_t row, int count) { counts_[row] = static_cast<std::uint32_t>(count); }

  /// Bytes in use.
  std::size_t memory() const {
    return indices_.capacity() * sizeof(pcl::index_t) + distances_.capacity() * sizeof(float) +
           counts_.capacity() * sizeof(std::uint32_t);
  }

 private:
  std::size_t rows_ = 0;
  int k_ = 0;
  FastVector<pcl::index_t> indices_;
  FastVector<float> distances_;
  std::vector<std::uint32_t> counts_;
};

/// The neighbours within a radius of every point: rows of different lengths, one after another in
/// flat arrays.
///
/// Rows belong to points and are ordered as in Neighborhoods. Memory: sizeof(pcl::index_t) + 4
/// bytes a neighbour, or sizeof(pcl::index_t) without distances, and 8 bytes a row.
class RadiusNeighborhoods {
 public:
  std::size_t size() const { return offsets_.size() - 1; }  ///< number of rows
  bool hasDistances() const { return with_distances_; }     ///< see sqrDistances()
  std::size_t entries() const { return offsets_.back(); }   ///< of all rows together
  std::size_t count(std::size_t row) const {                ///< entries in a row
    return offsets_[row + 1] - offsets_[row];
  }

  /// The row's neighbours, indices into the cloud.
  const pcl::index_t* indices(std::size_t row) const { return indices_.data() + offsets_[row]; }

  /// The row's squared distances, or null in a table without distances.
  const float* sqrDistances(std::size_t row) const {
    return with_distances_ ? distances_.data() + offsets_[row] : nullptr;
  }

  /// size() + 1 entries: where each row begins, and the end.
  const std::vector<std::size_t>& offsets() const { return offsets_; }

  /// For the search that fills the table: first reset(), then setCount() for rows that are not
  /// empty, then finishCounts(), then the entries.
  void reset(std::size_t rows, bool with_distances = true) {
    with_distances_ = with_distances;
    offsets_.assign(rows + 1, 0);
  }
  void setCount(std::size_t row, std::size_t count) { offsets_[row + 1] = count; }
  void finishCounts() {
    for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
    indices_.resize(entries());
    distances_.resize(with_distances_ ? entries() : 0);
  }
  pcl::index_t* mutableIndices(std::size_t row) { return indices_.data() + offsets_[row]; }
  float* mutableSqrDistances(std::size_t row) {
    return with_distances_ ? distances_.data() + offsets_[row] : nullptr;
  }

  /// Bytes in use.
  std::size_t memory() const {
    return indices_.capacity() * sizeof(pcl::index_t) + distances_.capacity() * sizeof(float) +
           offsets_.capacity() * sizeof(std::size_t);
  }

 private:
  bool with_distances_ = true;
  std::vector<std::size_t> offsets_ = {0};
  FastVector<pcl::index_t> indices_;
  FastVector<float> distances_;
};

}  // namespace segorient
