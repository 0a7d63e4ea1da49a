// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <cstddef>
#include <utility>

namespace segorient::detail {

/// A table of the nearest of some places, ascending, on several threads.
/// \param entries of a row at most \param threads see resolveThreads()
Neighborhoods nearestOfPlaces(const search::MedianHashIndex& index, const PointView& places,
                              int entries, int threads);

/// More neighbours than the table that all stages share has, for stages that need as many where
/// there is noise: searched for when asked for, and not kept.
class SEGORIENT_FEATURES_EXPORT MoreNeighbors {
 public:
  /// \param points must outlive this; \param threads see resolveThreads()
  MoreNeighbors(const PointView& points, int threads) : points_(points), threads_(threads) {}
  /// \param index of the points, or an empty one
  MoreNeighbors(const PointView& points, int threads, search::MedianHashIndex index)
      : points_(points), threads_(threads), indexed_(index.size() > 0), index_(std::move(index)) {}

  const PointView& points() const { return points_; }

  /// Of the points, built when first asked for: not from several threads.
  const search::MedianHashIndex& index();
  /// Gives the index's memory back unless somebody asked for it; it is built anew when asked for.
  void dropUnasked();

  /// Most neighbours of a single point, itself not counted.
  static constexpr int kMost = 60;
  /// The nearest of a point, itself first, from several threads once index() was called.
  /// \param entries kMost + 1 at most; \param row room for as many
  /// \return how many there are
  int nearest(std::size_t i, int entries, pcl::index_t* row) const;

 private:
  PointView points_;
  int threads_;
  bool indexed_ = false;
  bool asked_ = false;
  search::MedianHashIndex index_;
};

}  // namespace segorient::detail
