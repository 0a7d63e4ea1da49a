// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/common/impl/point_search.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "common/compact_cloud.h"
#include "common/prefetch.h"

namespace segorient {

/// A cloud made ready for the stages, once: its distinct finite points, in an order and a unit of
/// their own, the index on them, and the table of their neighbours. The stages see points only.
/// Whatever enters by input row is gathered here, and whatever leaves by row is scattered here.
///
/// Coordinates are those of the input over unit(), a power of two, so that nothing is rounded and
/// squares of lengths are ordinary numbers for any input.
class SEGORIENT_SEARCH_EXPORT PreparedCloud {
 public:
  PreparedCloud() = default;
  /// \param points must outlive the call only; rows that are not finite are left out
  /// \param indices rows to use, or null for all; entries out of range are left out, and other rows
  ///        have no point
  /// \param threads see resolveThreads()
  /// \param frame see compactCloud()
  PreparedCloud(const PointView& points, const pcl::Indices* indices, int threads,
                const Bounds* frame = nullptr);

  std::size_t size() const { return cloud_.size(); }         ///< points
  std::size_t rows() const { return cloud_.row_of.size(); }  ///< input rows
  PointView points() const { return cloud_.view(); }
  float unit() const { return cloud_.unit; }
  /// A place in input coordinates in those of points().
  std::array<float, 3> inUnit(std::array<float, 3> place) const {
    for (float& v : place) v /= unit();
    return place;
  }
  const CompactCloud& cloud() const { return cloud_; }

  /// The point of a row, -1 where it is not finite or not used.
  pcl::index_t pointOf(std::size_t row) const { return cloud_.row_of[row]; }
  /// The first row that holds a point.
  std::size_t rowOf(std::size_t point) const {
    return static_cast<std::size_t>(cloud_.source[point]);
  }
  std::size_t withoutPoint() const;  ///< rows that are not finite or not used
  std::size_t duplicates() const;    ///< rows that repeat another one's point

  /// The index on the points, built when it is first asked for.
  const search::MedianHashIndex& index();
  /// Gives the index's memory back; it is built anew if it is asked for again.
  void dropIndex();
  /// The same, for somebody else to keep; empty if it was not asked for before.
  search::MedianHashIndex takeIndex();

  /// Fills the table of neighbours. \param k of each point, itself not counted; fewer where there
  /// are fewer points \return how many there are
  int findNeighbors(int k, bool with_distances = true);
  /// The same by a user's search on the input, if there is one, asked for first rows. Repeated
  /// points are one neighbour.
  int findNeighbors(int k, const PointSearch& search);
  /// One row a point, the point itself first; empty before findNeighbors().
  const Neighborhoods& neighborhoods() const { return table_; }

  /// Values of points for all rows: rows that repeat a point have its values.
  /// \param width values a point \param none for rows without a point
  template <typename T>
  std::vector<T> scatter(const std::vector<T>& of_points, std::size_t width, T none) const;

 private:
  CompactCloud cloud_;
  int threads_ = 0;
  bool indexed_ = false;
  search::MedianHashIndex index_;
  Neighborhoods table_;
};

template <typename T>
std::vector<T> PreparedCloud::scatter(const std::vector<T>& of_points, std::size_t width,
                                      T none) const {
  std::vector<T> out(width * rows(), none);
  constexpr std::size_t kAhead = 16;  // the input may be in any order
  for (std::size_t row = 0; row < rows(); ++row) {
    if (row + kAhead < rows() && cloud_.row_of[row + kAhead] >= 0) {
      prefetch(&of_points[width * static_cast<std::size_t>(cloud_.row_of[row + kAhead])]);
    }
    if (cloud_.row_of[row] < 0) continue;
    std::copy_n(&of_points[width * static_cast<std::size_t>(cloud_.row_of[row])], width,
                &out[width * row]);
  }
  return out;
}

}  // namespace segorient
