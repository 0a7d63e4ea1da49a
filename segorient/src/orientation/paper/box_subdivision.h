// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/point_view.h>

#include <array>
#include <cstdint>
#include <vector>

namespace segorient {

/// The bounding box of a set of points, cut in halves until no box holds more than a given number
/// of points, and the empty boxes that can be reached from outside removed (paper, section 3.3).
///
/// Only the long edges of a box are halved, so that boxes stay near cubes whatever the object's
/// proportions; slivers would be empty by chance and let the outside in.
class BoxSubdivision {
 public:
  /// A face direction: axis 0..2, towards the larger coordinates or the smaller.
  struct Direction {
    int axis = 0;
    bool positive = false;
  };

  struct Box {
    std::array<std::uint32_t, 3> low{};   ///< in cells of a 2^20 grid over the bounding box
    std::array<std::uint32_t, 3> high{};  ///< exclusive
    std::uint32_t first = 0;              ///< into points()
    std::uint32_t size = 0;
    std::uint32_t first_child = 0;
    std::uint8_t children = 0;  ///< 0 = a leaf
    bool removed = false;       ///< empty, and connected to the outside by such boxes
  };

  /// \param rows points to use, all finite; may be a subset
  /// \param max_points most points in a box, at least 1
  BoxSubdivision(const PointView& points, const std::vector<pcl::index_t>& rows,
                 std::size_t max_points);

  const std::vector<Box>& boxes() const { return boxes_; }  ///< parents before children
  /// The rows by box: a leaf's are [first, first + size).
  const std::vector<pcl::index_t>& points() const { return rows_; }

  /// Whether nothing but removed boxes or the outside lies behind a face of a leaf.
  bool isFree(const Box& leaf, Direction direction) const;

 private:
  // A row and its place on the grid.
  struct Placed {
    std::array<std::uint32_t, 3> cell;
    pcl::index_t row;
  };

  std::vector<Placed> place(const PointView& points, const std::vector<pcl::index_t>& rows);
  void split(std::vector<Placed>& placed, std::size_t box, std::size_t max_points);
  void removeExterior();
  template <typename Visitor>
  void visitNeighbors(const Box& leaf, Direction direction, Visitor&& visit) const;

  std::array<double, 3> extent_{};
  std::vector<Box> boxes_;
  std::vector<pcl::index_t> rows_;
};

}  // namespace segorient
