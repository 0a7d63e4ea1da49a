// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <cstring>
#include <functional>
#include <limits>
#include <memory>

#include "segmentation/growth_state.h"

namespace segorient::segmentation {
namespace {

std::uint32_t orderedBits(float curvature) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &curvature, sizeof bits);
  // Ascending also for the negative values that some estimators write.
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

/// Seeds in the order of (curvature, index): a heap of blocks of points by the first seed that each
/// has left. As nearly all points join the segment of another one, a block is looked through again
/// for its next seed; where that happens often, its points are sorted.
class SeedOrder {
 public:
  explicit SeedOrder(const GrowthState& state)
      : nodes_(state.nodes), labels_(state.labels), blocks_(nodes_.size() / kBlock + 1) {
    firsts_.reserve(blocks_.size());
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      const std::uint64_t key = leastOf(block);
      if (key != kNone) firsts_.push_back(key);
    }
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

  static bool usable(const Node& p) { return std::isfinite(p.nx + p.ny + p.nz + p.x + p.y + p.z); }
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
      if (labels_[p] < 0 && usable(nodes_[p])) visit(keyOf(p));
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
  std::vector<Block> blocks_;
  std::vector<std::uint64_t> firsts_;
  std::vector<std::uint64_t> sorted_;  ///< block after block, each with kNone at its end
};

/// Grows one segment after the other; the queue is one array for all of them. The arrays are held
/// by plain pointers: this loop is most of the time that segmentation takes.
class Grower {
 public:
  Grower(const SegmentationOptions& options, GrowthState& state,
         std::vector<std::uint8_t>& on_border)
      : hood_(*state.neighborhoods),
        limits_(state.limits),
        scattered_(state.scattered),
        row_size_(state.neighbors),
        cos_alpha_(options.alpha < kRightAngle ? std::cos(options.alpha) : 0.F),
        cos_beta_(options.beta < kRightAngle ? std::cos(options.beta) : -1.F),
        sqr_cos_beta_(static_cast<double>(cos_beta_) * static_cast<double>(cos_beta_)),
        max_curvature_(options.max_curvature),
        max_residual_(scaledResidual(options, state)),
        compare_with_seed_(options.compare_with_seed),
        nodes_(state.nodes.data()),
        labels_(state.labels.data()),
        signs_(state.signs.data()),
        on_border_(on_border.data()),
        clusters_(state.clusters),
        queue_(new pcl::index_t[state.nodes.size()]) {
    for (std::size_t p = 0; p < state.nodes.size() && full_; ++p)
      full_ = hood_.count(p) >= row_size_;
  }

  void grow(std::size_t seed) {
    label_ = static_cast<std::int32_t>(clusters_.size());
    cluster_ = Cluster{};
    tail_ = 0;
    seed_ = nodes_[seed];
    accept(seed, 1, true);
    for (std::size_t head = 0; head < tail_; ++head) {
      // Fetches ahead: rows, the labels of points in them unless they are likely to be here, and
      // the points in the farther half of a row, where growing has not been yet. Not in a function
      // of its own, which compilers leave out as one without effects.
      if (head + kRowsAhead < tail_) {
        __builtin_prefetch(hood_.indices(static_cast<std::size_t>(queue_[head + kRowsAhead])));
      }
      if (scattered_ && head + kLabelsAhead < tail_) {
        const auto p = static_cast<std::size_t>(queue_[head + kLabelsAhead]);
        const pcl::index_t* row = hood_.indices(p);
        for (int j = 1, end = rowSize(p); j < end; ++j) __builtin_prefetch(labels_ + row[j]);
      }
      if (head + kNodesAhead < tail_) {
        const auto p = static_cast<std::size_t>(queue_[head + kNodesAhead]);
        const pcl::index_t* row = hood_.indices(p);
        for (int j = row_size_ / 2, end = rowSize(p); j < end; ++j) {
          __builtin_prefetch(nodes_ + row[j]);
        }
      }
      spread(static_cast<std::size_t>(queue_[head]));
    }
    clusters_.push_back(cluster_);
  }

 private:
  static constexpr std::size_t kRowsAhead = 32;
  static constexpr std::size_t kLabelsAhead = 16;
  static constexpr std::size_t kNodesAhead = 12;
  static constexpr int kMaskBits = 32;
  static constexpr float kRightAngle = 1.5707963F;

  // The table of counts is looked into only where it has something to tell.
  int rowSize(std::size_t p) const {
    return full_ ? row_size_ : std::min(hood_.count(p), row_size_);
  }

  void accept(std::size_t q, int sign, bool flat) {
    Node& node = nodes_[q];
    if (sign < 0) {
      node.nx = -node.nx;
      node.ny = -node.ny;
      node.nz = -node.nz;
    }
    labels_[q] = label_;
    signs_[q] = static_cast<std::int8_t>(sign);
    cluster_.normal.add(node);
    ++cluster_.size;
    threshold_ = sqr_cos_beta_ * cluster_.normal.squaredNorm();
    if (!flat || (node.curvature > max_curvature_ && cluster_.size > 1)) return;
    queue_[tail_++] = static_cast<pcl::index_t>(q);
  }

  void spread(std::size_t p) {
    const pcl::index_t* row = hood_.indices(p);
    const int count = rowSize(p);
    const Node node = nodes_[p];
    std::uint8_t border = 0;
    for (int first = 1; first < count; first += kMaskBits) {
      const int last = std::min(count, first + kMaskBits);
      for (std::uint32_t others = othersAmong(row + first, last - first); others != 0;
           others &= others - 1) {
        const auto q = static_cast<std::size_t>(row[first + __builtin_ctz(others)]);
        if (labels_[q] == label_) continue;  // twice in the row
        if (labels_[q] >= 0 || !tryAccept(node, q)) border = 1;
      }
    }
    on_border_[p] = border;
  }

  // Bit j is set if neighbour j is not in this segment. Nearly all are, and which are not is
  // nothing that a processor could guess: no branches.
  std::uint32_t othersAmong(const pcl::index_t* neighbors, int count) const {
    std::uint32_t others = 0;
    const auto other = [&](int j) {
      return static_cast<std::uint32_t>(labels_[neighbors[j]] != label_);
    };
    int j = 0;
    for (; j + 4 <= count; j += 4) {
      others |= (other(j) | other(j + 1) << 1 | other(j + 2) << 2 | other(j + 3) << 3) << j;
    }
    for (; j < count; ++j) others |= other(j) << j;
    return others;
  }

  // Without signs the angle to the neighbour is |cos|; the sign that it gives must also bring the
  // normal within beta of the reference.
  bool tryAccept(const Node& p, std::size_t q) {
    const Node& candidate = nodes_[q];
    const float cosine = dotNormals(compare_with_seed_ ? seed_ : p, candidate);
    if (!(std::abs(cosine) >= cos_alpha_) || !limits_.admissible(p, candidate)) return false;
    const int sign = cosine < 0.F ? -1 : 1;
    const double along = sign * cluster_.normal.dot(candidate);
    if (cos_beta_ > 0.F && !(along > 0.0 && along * along >= threshold_)) return false;
    accept(q, sign, residual(p, candidate) <= max_residual_);
    return true;
  }

  const Neighborhoods& hood_;
  PairLimits limits_;
  bool scattered_;
  int row_size_;
  bool full_ = true;  ///< no row is shorter
  float cos_alpha_;
  float cos_beta_;  ///< negative = no condition on the reference normal
  double sqr_cos_beta_;
  float max_curvature_;
  float max_residual_;
  bool compare_with_seed_;
  Node seed_{};
  Node* nodes_;
  std::int32_t* labels_;
  std::int8_t* signs_;
  std::uint8_t* on_border_;  ///< 0 = surely no neighbour in another segment
  std::vector<Cluster>& clusters_;
  std::unique_ptr<pcl::index_t[]> queue_;
  std::size_t tail_ = 0;
  std::int32_t label_ = 0;
  Cluster cluster_;
  double threshold_ = 0.0;  ///< squared length that the sum must have along a candidate
};

// Eight at a time: nearly all are 0.
void listBorder(const std::vector<std::uint8_t>& on_border, GrowthState& state) {
  const std::size_t n = on_border.size();
  for (std::size_t first = 0; first < n; first += sizeof(std::uint64_t)) {
    std::uint64_t any = 0;
    const std::size_t count = std::min(sizeof any, n - first);
    std::memcpy(&any, on_border.data() + first, count);
    if (any == 0) continue;
    for (std::size_t p = first; p < first + count; ++p) {
      if (on_border[p] != 0 && state.labels[p] >= 0)
        state.border.push_back(static_cast<pcl::index_t>(p));
    }
  }
}

}  // namespace

void grow(const SegmentationOptions& options, GrowthState& state) {
  const std::size_t n = state.nodes.size();
  state.labels.assign(n, -1);
  state.signs.assign(n, 1);
  std::vector<std::uint8_t> on_border(n, 1);
  SeedOrder seeds(state);
  Grower grower(options, state, on_border);
  for (std::size_t seed = 0; seeds.next(seed);) grower.grow(seed);
  listBorder(on_border, state);
}

}  // namespace segorient::segmentation
