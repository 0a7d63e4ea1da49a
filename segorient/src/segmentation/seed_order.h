// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "common/parallel_for.h"
#include "segmentation/growth_state.h"

namespace segorient::segmentation {

/// Seeds in the order of (curvature, index): a heap of blocks of points by the first seed that each
/// has left. As nearly all points join the segment of another one, a block is looked through again
/// for its next seed; where that happens often, its points are sorted.
class SeedOrder {
 public:
  /// \param allowed not 0 at the points that may be seeds; null = all
  SeedOrder(const GrowthState& state, int threads, const std::uint8_t* allowed = nullptr)
      : nodes_(state.nodes),
        labels_(state.labels),
        allowed_(allowed),
        blocks_(nodes_.size() / kBlock + 1) {
    firsts_.resize(blocks_.size());
    parallelFor(blocks_.size(), threads, 10.0 * kBlock,
                [&](std::size_t block) { firsts_[block] = leastOf(block); });
    firsts_.erase(std::remove(firsts_.begin(), firsts_.end(), kNone), firsts_.end());
    std::make_heap(firsts_.begin(), firsts_.end(), std::greater<>());
  }

  /// The next point without a label; false when all have one.
  bool next(std::size_t& seed) {
    while (!firsts_.empty()) {
      seed = pointOf(firsts_.front());
      if (labels_[seed] < 0) return true;
      std::pop_heap(firsts_.begin(), firsts_.end(), std::greater<>());
      firsts_.back() = nextOf(seed / kBlock);
      if (firsts_.back() == kNone) {
        firsts_.pop_back();
      } else {
        std::push_heap(firsts_.begin(), firsts_.end(), std::greater<>());
      }
    }
    return false;
  }

 private:
  static constexpr std::size_t kBlock = 64;
  /// Looking through a block takes about a quarter of the time that sorting it does.
  static constexpr int kMostScans = 4;
  static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

  struct Block {
    int scans = 0;
    std::size_t at = 0;  ///< once it is sorted, its next entry in sorted_
  };

  bool usable(std::size_t i) const {
    const Node& p = nodes_[i];
    return std::isfinite(p.nx + p.ny + p.nz + p.x + p.y + p.z) &&
           (allowed_ == nullptr || allowed_[i] != 0);
  }
  static std::uint32_t orderedBits(float curvature) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &curvature, sizeof bits);
    // Ascending also for the negative values that some estimators write.
    return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
  }
  // Curvature above, index below.
  std::uint64_t keyOf(std::size_t p) const {
    return std::uint64_t{orderedBits(nodes_[p].curvature)} << 32U | p;
  }
  static std::size_t pointOf(std::uint64_t key) {
    return static_cast<std::size_t>(key & 0xffffffffU);
  }

  template <typename Visit>
  void forEachSeed(std::size_t block, Visit&& visit) const {
    const std::size_t end = std::min(nodes_.size(), (block + 1) * kBlock);
    for (std::size_t p = block * kBlock; p < end; ++p) {
      if (labels_[p] < 0 && usable(p)) visit(keyOf(p));
    }
  }

  std::uint64_t leastOf(std::size_t block) const {
    std::uint64_t least = kNone;
    forEachSeed(block, [&](std::uint64_t key) { least = std::min(least, key); });
    return least;
  }

  std::uint64_t nextOf(std::size_t index) {
    Block& block = blocks_[index];
    if (block.scans < kMostScans) {
      ++block.scans;
      return leastOf(index);
    }
    if (block.scans == kMostScans) {
      ++block.scans;
      block.at = sorted_.size();
      forEachSeed(index, [&](std::uint64_t key) { sorted_.push_back(key); });
      std::sort(sorted_.begin() + static_cast<std::ptrdiff_t>(block.at), sorted_.end());
      sorted_.push_back(kNone);
    }
    while (sorted_[block.at] != kNone && labels_[pointOf(sorted_[block.at])] >= 0) ++block.at;
    return sorted_[block.at];
  }

  const FastVector<Node>& nodes_;
  const std::vector<std::int32_t>& labels_;
  const std::uint8_t* allowed_;
  std::vector<Block> blocks_;
  std::vector<std::uint64_t> firsts_;
  std::vector<std::uint64_t> sorted_;  ///< block after block, each with kNone at its end
};

}  // namespace segorient::segmentation
