// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>

namespace segorient::detail {

/// More neighbours than the table that all stages share has, for stages that need as many where
/// there is noise: of all points, found once and when first asked for, or point by point.
class SEGORIENT_FEATURES_EXPORT MoreNeighbors {
 public:
  /// Of each point, itself not counted: those of the largest planes of scans (60) and of the
  /// largest surfaces (64), and some to vote beyond them.
  static constexpr int kCount = 66;

  /// \param points must outlive this; \param threads see resolveThreads()
  MoreNeighbors(const PointView& points, int threads) : points_(points), threads_(threads) {}

  const PointView& points() const { return points_; }

  /// Of all points, each row with the point itself first.
  const Neighborhoods& ofAll();
  bool hasAll() const { return all_.k() > 0; }

  /// Makes row() ready for use, from several threads.
  void prepareRows();
  struct Row {
    const pcl::index_t* indices;
    int count;
  };
  using Room = std::array<pcl::index_t, kCount + 1>;
  /// The nearest of a point, itself first.
  /// \param entries of the row; kCount + 1 at most
  /// \param room of the caller, where the row may be
  Row row(std::size_t i, int entries, Room& room) const;

 private:
  void build();

  PointView points_;
  int threads_;
  bool indexed_ = false;
  search::MedianHashIndex index_;
  Neighborhoods all_;
};

}  // namespace segorient::detail
