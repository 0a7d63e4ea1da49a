// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What a thread remembers of its queries, so that those near the one before are answered faster.
// What is found does not depend on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "search/kernels.h"

namespace segorient::search {

/// The last query: if the next one is near, its radius is a good guess.
struct LastQuery {
  std::uint64_t index = 0;  ///< number of the structure that was searched
  std::size_t k = 0;
  float point[3] = {0.0F, 0.0F, 0.0F};
  float limit = 0.0F;  ///< squared distance to the k-th neighbour
  /// Squared distance from a point to its 16th neighbour, typically, where that was looked up last.
  float spacing16 = 0.0F;

  bool isNear(const float* q) const {
    // From a place that is away from the points, the k nearest are all about equally far: what is
    // nearer than a bit more than that are many. On a surface, the shell of kShell of the squared
    // distance cuts a disc of as many points out.
    constexpr float kShell = 0.3F;
    constexpr float kMostInShell = 64.0F;
    const float most = kMostInShell + 4.0F * static_cast<float>(k);
    if (!(16.0F * kShell * limit <= most * spacing16)) return false;
    const float dx = q[0] - point[0];
    const float dy = q[1] - point[1];
    const float dz = q[2] - point[2];
    return dx * dx + dy * dy + dz * dz < limit;
  }
};

/// Whether queries are likely to be away from the points: as long as guesses fail, fewer and fewer
/// queries begin with one.
class AwayFromPoints {
 public:
  bool isLikely() { return waited_ < wait_ && ++waited_ > 0; }
  void was(bool away) {
    wait_ = away ? std::min(2 * wait_ + 1, kLongestWait) : 0;
    waited_ = 0;
  }
  void reset() { was(false); }

 private:
  static constexpr int kLongestWait = 63;
  int wait_ = 0;    // queries to begin without a guess
  int waited_ = 0;  // how many there were
};

/// The last query whose neighbours are all equally far, as where more points are in one place than
/// were sought: all that are there have the same answer, and each would have to look at all of
/// them.
class CrowdedPlace {
 public:
  /// \return false if that was another place
  bool answer(std::uint64_t index, const float* q, std::size_t k, pcl::index_t* indices,
              float* distances) const {
    if (index != index_ || k != indices_.size() || !std::equal(q, q + 3, point_)) return false;
    std::copy(indices_.begin(), indices_.end(), indices);
    std::fill_n(distances, k, distance_);
    return true;
  }

  /// \param distance that of all k
  void remember(std::uint64_t index, const float* q, std::size_t k, const pcl::index_t* indices,
                float distance) {
    index_ = index;
    std::copy_n(q, 3, point_);
    indices_.assign(indices, indices + k);
    distance_ = distance;
  }

 private:
  std::uint64_t index_ = 0;  // none has this number
  float point_[3] = {0.0F, 0.0F, 0.0F};
  float distance_ = 0.0F;
  std::vector<pcl::index_t> indices_;
};

/// All points in and around a cube, where queries next to each other find theirs.
class SharedBlock {
 public:
  /// Whether q is in the cube and so many neighbours are sought as when it was gathered.
  bool covers(std::uint64_t index, const float* q, std::size_t k) const {
    bool inside = index == index_ && k == k_;
    for (int a = 0; a < 3; ++a) inside = inside && q[a] >= box_.lo[a] && q[a] <= box_.hi[a];
    return inside;
  }

  /// Gathers what queries around q need, where squared distances to the k-th neighbour are about
  /// `typical`. Not every time if few queries were served lately.
  bool refill(const Kernels& kernels, const Layout& layout, std::uint64_t index, const float* q,
              float typical, std::size_t k) {
    if (waited_++ < wait_) return false;
    wait_ = served_ < kFewServed ? std::min(2 * wait_ + 1, kLongestWait) : 0;
    waited_ = 0;
    served_ = 0;
    index_ = 0;
    k_ = k;
    reserve(kLeastRoom + kRoomPerNeighbor * k);
    const float deviation = 1.0F / std::sqrt(static_cast<float>(k));
    guess_.margin = 1.0F + kMargin * deviation;
    guess_.typical = typical;
    reach_ = kReach * guess_.margin * typical;
    const float half = half_edge_ * std::sqrt(typical);
    for (int a = 0; a < 3; ++a) {
      box_.lo[a] = q[a] - half;
      box_.hi[a] = q[a] + half;
    }
    if (!(reach_ < std::numeric_limits<float>::infinity()) ||
        !kernels.gatherAround(LayoutView(layout), box_, reach_, block_)) {
      return false;
    }
    const std::size_t wanted = kPoints + kPointsPerNeighbor * k;
    if (block_.count > wanted) half_edge_ = std::max(0.9F * half_edge_, 0.2F);
    if (block_.count < wanted) half_edge_ = std::min(1.1F * half_edge_, 2.0F);
    index_ = index;
    return true;
  }

  /// The k nearest of a query that is covered; see Kernels::nearestInBlock().
  bool nearest(const Kernels& kernels, const float* q, Candidates& room, const SortScratch& sort,
               pcl::index_t* indices, float* distances) {
    ++served_;
    return kernels.nearestInBlock(block_, q, reach_, k_, guess_, room, sort, indices, distances);
  }

  std::size_t capacity() const { return block_.capacity; }

 private:
  // Points of a block: more make each query longer, fewer serve fewer of them.
  static constexpr std::size_t kPoints = 30;
  static constexpr std::size_t kPointsPerNeighbor = 5;
  // By how much squared radii may grow within the cube.
  static constexpr float kReach = 1.3F;
  // To gather takes as long as so many queries.
  static constexpr int kFewServed = 3;
  static constexpr int kLongestWait = 31;
  static constexpr std::size_t kLeastRoom = 1024;
  static constexpr std::size_t kRoomPerNeighbor = 16;

  void reserve(std::size_t capacity) {
    if (capacity <= block_.capacity) return;
    const std::size_t length = wholeLines(capacity + Layout::kPadding);
    floats_.resize(3 * length + kLine);
    ids_.resize(length + kLine);
    for (std::size_t a = 0; a < 3; ++a) block_.xyz[a] = firstOfLine(floats_) + a * length;
    block_.id = firstOfLine(ids_);
    block_.capacity = capacity;
  }

  std::uint64_t index_ = 0;
  std::size_t k_ = 0;
  float half_edge_ = 1.0F;  // of the cube, relative to the radius of a search
  Box box_{};
  Guess guess_{};
  float reach_ = 0.0F;
  int wait_ = 0;    // queries to be left alone until the next block is gathered
  int waited_ = 0;  // how many there were
  int served_ = 0;  // by the block
  Block block_{};
  std::vector<float> floats_;
  std::vector<std::uint32_t> ids_;
};

/// All of it, about one structure.
struct Recent {
  LastQuery last;
  AwayFromPoints away;
  CrowdedPlace crowded;
  SharedBlock shared;
};

/// What is remembered of the two structures that were searched last: some programs ask two in turn.
class RecentPair {
 public:
  /// \param index number of a structure, above 0. If it is none of the two, it takes the place of
  ///        the one that was asked less recently, and nothing is known of it
  Recent& of(std::uint64_t index) {
    if (slots_[latest_].last.index == index) return slots_[latest_];
    latest_ = 1 - latest_;
    Recent& slot = slots_[latest_];
    if (slot.last.index != index) {
      // Its own from now on. No query is for 0 neighbours, so that none is near this one.
      slot.last = LastQuery{};
      slot.last.index = index;
      slot.away.reset();
    }
    return slot;
  }

 private:
  Recent slots_[2];
  std::size_t latest_ = 0;
};

}  // namespace segorient::search
