// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/box.h"
#include "orientation/winding/dipole_sums.h"

namespace segorient {

/// A node of its tree.
struct WindingNode {
  float center[3];
  float radius;
  float dipole[3];
  std::uint32_t skip;   ///< next node when this one is used or done
  std::uint32_t first;  ///< leaf: first point
  std::uint32_t size;   ///< leaf: points, 0 for inner nodes
};

/// Winding number of oriented points (Barill et al. 2018, "Fast winding numbers for soups and
/// clouds"): w(x) = sum a n.(p - x) / (4 pi max(|p - x|, r)^3): 1 inside a closed outward cloud, 0
/// outside, 1/2 on it.
///
/// A tree over runs of points that are near each other in memory; a node far enough away counts as
/// one dipole. Building is linear, evaluating logarithmic.
class WindingNumber {
 public:
  /// \param points all points, near ones side by side (CompactCloud's order)
  /// \param dipoles 4 floats a point: area-weighted normal, area
  /// \param rows points to use, ascending; empty = all. All three must outlive this object's use
  /// \param threads see resolveThreads()
  void build(const PointView& points, const float* dipoles, const std::vector<std::uint32_t>& rows,
             int threads = 1);

  /// \param x where \param radius below which points are smoothed, usually the spacing
  float evaluate(const float* x, float radius) const;

  /// The same numbers for many places, several at a time, to the last bit.
  /// \param at near ones side by side \param radii one of each, numbers \return one of each
  std::vector<float> evaluate(const PointView& at, const std::vector<float>& radii,
                              int threads) const;

  /// Appends dipoles that stand for all points when seen from a ball: points near it themselves,
  /// others together.
  /// \param center of the ball \param reach its radius
  /// \param points all that this was built from, in the order of its rows
  void listDipoles(const float* center, float reach, const DipoleList& points,
                   DipoleList& out) const;

 private:
  using Node = WindingNode;
  struct Extent {
    double area = 0.0;
    Box box;
  };
  /// Points [first, last), and the nodes over them from that index on.
  struct Part {
    std::uint32_t first, last, index;
    Extent extent;
  };
  static void listParts(std::uint32_t first, std::uint32_t last, std::uint32_t index,
                        std::vector<Part>& parts);
  /// The nodes over [first, last); what is over `most` points or less is built by bottom(), called
  /// with these two and the index.
  template <typename Bottom>
  Extent buildDownTo(std::uint32_t most, std::uint32_t first, std::uint32_t last,
                     std::uint32_t index, const Bottom& bottom);
  Extent buildLeaf(std::uint32_t first, std::uint32_t last, std::uint32_t index);
  void finish(std::uint32_t index, std::uint32_t end, const Extent& extent);
  Extent sumLeaf(Node& node) const;
  static Extent sumHalves(const Node& a, const Extent& in_a, const Node& b, const Extent& in_b,
                          Node& node);
  std::size_t row(std::uint32_t i) const { return rows_ != nullptr ? rows_[i] : i; }

  PointView points_;
  const float* dipoles_ = nullptr;
  const std::uint32_t* rows_ = nullptr;
  std::vector<Node> nodes_;
};

}  // namespace segorient
