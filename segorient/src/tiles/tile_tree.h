// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// Cuts space into tiles of about as many points each, where the points are: a k-d tree over a
/// sample of a cloud. Below the tiles it goes on to small cells, which know how dense the points
/// are there, and so how wide a halo around a tile has to be.
///
/// Every place belongs to one tile. Beyond its own points, a tile is given the points of others
/// that lie within kHaloSpacings of their own local spacing of its cell.
class SEGORIENT_TILES_EXPORT TileTree {
 public:
  using Place = std::array<double, 3>;

  /// One cell; its lower half comes next in the list.
  struct Node {
    double split = 0.0;        ///< places below it along `axis` are in the lower half
    double reach = 0.0;        ///< without halves: how far away a tile may be that takes its points
    std::int32_t axis = -1;    ///< -1: no halves
    std::uint32_t upper = 0;   ///< the upper half
    std::int32_t tile = -1;    ///< the tile that this cell is, -1 above and below tiles
    std::uint32_t unused = 0;  ///< no hidden bytes: nodes are stored as they are
  };

  TileTree() = default;
  /// \param sample places, finite; none = one tile
  /// \param points_each how many points of the cloud each of them stands for
  /// \param most_points of a tile; only points that are all in one place may be more
  ///        Bodies are tiles of their own where floats near one place would not resolve both.
  TileTree(std::vector<Place> sample, double points_each, double most_points);
  /// A tree as it was stored. \return false, and an empty tree, if it is none
  static bool restore(std::vector<Node> nodes, TileTree& tree);

  const std::vector<Node>& nodes() const { return nodes_; }
  std::size_t tiles() const { return tiles_; }

  /// Makes halos so many times as wide.
  void widen(double factor) {
    for (Node& n : nodes_) n.reach *= factor;
  }

  /// The tile that a place belongs to, and how far from it other tiles take it along.
  std::uint32_t owner(const Place& p, double& reach) const;
  /// The cell that a place is in: its number in the list of nodes.
  std::uint32_t cellOf(const Place& p) const {
    std::uint32_t n = 0;
    while (nodes_[n].axis >= 0) n = halfOf(n, p);
    return n;
  }
  /// The cells of several places: faster than one by one, as steps do not wait for each other.
  void findCells(const Place* places, std::size_t count, std::uint32_t* cells) const;
  /// Of a node that has halves, the one that a place is in.
  std::uint32_t halfOf(std::uint32_t n, const Place& p) const {
    const Node& node = nodes_[n];
    return p[static_cast<std::size_t>(node.axis)] < node.split ? n + 1 : node.upper;
  }

  /// A cell that has no halves, or a tile: all of space together, so that those at the rim have no
  /// end.
  struct Box {
    std::uint32_t node = 0;
    std::uint32_t tile = 0;
    Place low{};
    Place high{};
    /// Whether another one is within a distance along every axis.
    bool isWithin(const Box& other, double distance) const {
      for (std::size_t a = 0; a < 3; ++a) {
        if (other.low[a] - high[a] > distance || low[a] - other.high[a] > distance) return false;
      }
      return true;
    }
  };
  std::vector<Box> cells() const;
  std::vector<Box> tileBoxes() const;  ///< by tile

  /// Within what distance from a place a tile has all points that there are.
  /// \param reach of the place, as owner() tells \param distance of the tile's cell from it
  double wholeRadius(const Place& p, double reach, double distance) const;

  /// Calls visit(tile, distance) for each tile whose cell is within `reach` along every axis, the
  /// owner too, which is at 0.
  template <typename Visit>
  void forEachWithin(const Place& p, double reach, Visit&& visit) const {
    if (!nodes_.empty()) descend(0, p, reach, 0.0, visit);
  }

 private:
  struct Builder;
  double leastReach(std::uint32_t n, const Place& p, double radius) const;
  template <typename Visit>
  void descend(std::uint32_t n, const Place& p, double reach, double distance,
               Visit&& visit) const {
    while (nodes_[n].tile < 0) {
      const Node& node = nodes_[n];
      const double above = p[static_cast<std::size_t>(node.axis)] - node.split;
      const bool lower = above < reach;
      const bool upper = above >= -reach;
      if (lower && upper) descend(node.upper, p, reach, std::max(distance, -above), visit);
      if (lower) distance = std::max(distance, above);
      if (!lower) distance = std::max(distance, -above);
      n = lower ? n + 1 : node.upper;
    }
    visit(static_cast<std::uint32_t>(nodes_[n].tile), distance);
  }

  std::vector<Node> nodes_;
  std::size_t tiles_ = 0;
};

}  // namespace segorient
