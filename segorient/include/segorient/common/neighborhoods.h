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

}  // namespace segorient
