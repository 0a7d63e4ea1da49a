// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Boxes in boxes around the points of a layout: for queries away from all points, where cells tell
// nothing and what is needed is to leave out as much as possible as early as possible.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/layout.h"

namespace segorient::search {

/// Boxes below a node, and points of a leaf: whole vectors of any instruction set.
constexpr std::size_t kBoxFanOut = 16;

/// Points in one place that a region keeps: no box can tell them apart, so that each query nearby
/// looks at all of them. More neighbours are found another way where there are such places.
constexpr std::size_t kMostInOnePlace = 32;

/// Points in arrays of their own; lanes without a point are infinitely far from everything.
struct PointLeaf {
  float xyz[3][kBoxFanOut];
  std::uint32_t id[kBoxFanOut];
};

/// Up to kBoxFanOut boxes side by side, those that are not there infinitely far away. Below them
/// are nodes, leaves, or regions from `first_region` on.
struct BoxNode {
  float lo[3][kBoxFanOut];
  float hi[3][kBoxFanOut];
  const BoxNode* nodes = nullptr;
  const PointLeaf* leaves = nullptr;
  std::uint32_t first_region = 0;
};

/// The boxes of one region, with a copy of its points.
struct RegionBoxes {
  std::vector<BoxNode> nodes;  ///< the root first
  std::vector<PointLeaf> leaves;
  bool thinned = false;  ///< not all of its points are there, see kMostInOnePlace

  std::size_t memory() const {
    return nodes.capacity() * sizeof(BoxNode) + leaves.capacity() * sizeof(PointLeaf);
  }
};

/// The boxes of a layout. Each region's are made when a query first comes near it, so that nobody
/// pays for them who stays on the surface. May be used by several threads at once.
class BoxTree {
 public:
  explicit BoxTree(const Layout& layout);
  ~BoxTree();
  BoxTree(const BoxTree&) = delete;
  BoxTree& operator=(const BoxTree&) = delete;

  /// The topmost node.
  const BoxNode* root() { return top_.empty() ? region(0) : top_.data(); }
  /// The topmost node of a region.
  const BoxNode* region(std::size_t number) {
    const RegionBoxes* const made = regions_[number].load(std::memory_order_acquire);
    return made != nullptr ? made->nodes.data() : makeRegion(number);
  }
  std::size_t memory() const { return memory_; }
  /// Whether points of some region made so far were left out, see kMostInOnePlace.
  bool isThinned() const { return thinned_; }

 private:
  const BoxNode* makeRegion(std::size_t number);

  const Layout& layout_;
  std::vector<BoxNode> top_;
  std::vector<std::atomic<const RegionBoxes*>> regions_;
  std::atomic<std::size_t> memory_;
  std::atomic<bool> thinned_;
};

/// The k nearest so far, ascending, each as its distance's bits above its id: positive floats are
/// in the order of their bits. Free places hold a limit instead.
struct NearestKeys {
  std::uint64_t* keys;
  std::size_t k;
  float limit;  ///< what a point must be nearer than to be one of them
};

/// A search in a BoxTree.
struct BoxSearch {
  float query[3];
  float prune;  ///< boxes not nearer than the limit times this may be left out
  NearestKeys best;
  const BoxNode* (*region)(BoxTree&, std::size_t number);
  BoxTree* tree;
};

}  // namespace segorient::search
