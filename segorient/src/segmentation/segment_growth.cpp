// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <cstring>
#include <memory>

#include "growth_state.h"

namespace segorient::segmentation {
namespace {

std::uint32_t orderedBits(float curvature) {
  if (std::isnan(curvature)) return 0xffffffffU;
  std::uint32_t bits = 0;
  std::memcpy(&bits, &curvature, sizeof bits);
  // Ascending also for the negative values that some estimators write.
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

/// Seeds in the order of (curvature, index). Sorted by the upper bits at first, into about as many
/// buckets as there are points; those of one bucket are put in their exact order when growing comes
/// to it and most of them are taken.
class SeedOrder {
 public:
  explicit SeedOrder(const std::vector<Node>& nodes)
      : nodes_(nodes), shift_(32U - bitsFor(nodes.size())), starts_((1U << (32U - shift_)) + 1, 0) {
    for (const Node& p : nodes_) {
      if (usable(p)) ++starts_[bucketOf(p) + 1];
    }
    for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
    points_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (usable(nodes_[i])) points_[next[bucketOf(nodes_[i])]++] = static_cast<pcl::index_t>(i);
    }
  }

  template <typename Visit>
  void forEachUnlabelled(const std::vector<std::int32_t>& labels, Visit&& visit) {
    for (std::size_t b = 0; b + 1 < starts_.size(); ++b) {
      const auto begin = points_.begin() + static_cast<std::ptrdiff_t>(starts_[b]);
      const auto end = points_.begin() + static_cast<std::ptrdiff_t>(starts_[b + 1]);
      if (begin == end) continue;
      const auto left = std::remove_if(
          begin, end, [&](pcl::index_t p) { return labels[static_cast<std::size_t>(p)] >= 0; });
      const auto earlier = [&](pcl::index_t p, pcl::index_t q) {
        const std::uint32_t a = orderedBits(nodes_[static_cast<std::size_t>(p)].curvature);
        const std::uint32_t c = orderedBits(nodes_[static_cast<std::size_t>(q)].curvature);
        return a != c ? a < c : p < q;
      };
      // On exact planes all are equal.
      if (!std::is_sorted(begin, left, earlier)) std::sort(begin, left, earlier);
      for (auto it = begin; it != left; ++it) {
        if (labels[static_cast<std::size_t>(*it)] < 0) visit(static_cast<std::size_t>(*it));
      }
    }
  }

 private:
  static unsigned bitsFor(std::size_t points) {
    unsigned bits = 1;
    while (bits < 16 && (std::size_t{1} << bits) < points) ++bits;
    return bits;
  }
  static bool usable(const Node& p) { return std::isfinite(p.nx + p.ny + p.nz + p.x + p.y + p.z); }
  std::size_t bucketOf(const Node& p) const { return orderedBits(p.curvature) >> shift_; }

  const std::vector<Node>& nodes_;
  unsigned shift_;  ///< bits that the buckets leave out
  std::vector<std::size_t> starts_;
  std::vector<pcl::index_t> points_;
};

/// Grows one segment after the other; the queue is one array for all of them. The arrays are held
/// by plain pointers: this loop is most of the time that segmentation takes.
class Grower {
 public:
  Grower(const SegmentationOptions& options, GrowthState& state)
      : hood_(*state.neighborhoods),
        limits_(state.limits),
        row_size_(state.neighbors),
        cos_alpha_(options.alpha < kRightAngle ? std::cos(options.alpha) : 0.F),
        cos_beta_(options.beta < kRightAngle ? std::cos(options.beta) : -1.F),
        sqr_cos_beta_(static_cast<double>(cos_beta_) * static_cast<double>(cos_beta_)),
        max_curvature_(options.max_curvature),
        nodes_(state.nodes.data()),
        labels_(state.labels.data()),
        signs_(state.signs.data()),
        on_border_(state.on_border.data()),
        clusters_(state.clusters),
        queue_(new pcl::index_t[state.nodes.size()]) {
    for (std::size_t p = 0; p < state.nodes.size() && full_; ++p)
      full_ = hood_.count(p) >= row_size_;
  }

  void grow(std::size_t seed) {
    label_ = static_cast<std::int32_t>(clusters_.size());
    cluster_ = Cluster{};
    tail_ = 0;
    accept(seed, 1);
    for (std::size_t head = 0; head < tail_; ++head) {
      // Fetches ahead: rows, and the points in the farther half of a row, where growing has not
      // been yet. Not in a function of its own, which compilers leave out as one without effects.
      if (head + kRowsAhead < tail_) {
        __builtin_prefetch(hood_.indices(static_cast<std::size_t>(queue_[head + kRowsAhead])));
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
  static constexpr std::size_t kRowsAhead = 10;
  static constexpr std::size_t kNodesAhead = 3;
  static constexpr int kMaskBits = 32;
  static constexpr float kRightAngle = 1.5707963F;

  // The table of counts is looked into only where it has something to tell.
  int rowSize(std::size_t p) const {
    return full_ ? row_size_ : std::min(hood_.count(p), row_size_);
  }

  void accept(std::size_t q, int sign) {
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
    if (node.curvature > max_curvature_ && cluster_.size > 1) return;
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
    const float cosine = dotNormals(p, candidate);
    if (!(std::abs(cosine) >= cos_alpha_) || !limits_.admissible(p, candidate)) return false;
    const int sign = cosine < 0.F ? -1 : 1;
    const double along = sign * cluster_.normal.dot(candidate);
    if (cos_beta_ > 0.F && !(along > 0.0 && along * along >= threshold_)) return false;
    accept(q, sign);
    return true;
  }

  const Neighborhoods& hood_;
  PairLimits limits_;
  int row_size_;
  bool full_ = true;  ///< no row is shorter
  float cos_alpha_;
  float cos_beta_;  ///< negative = no condition on the reference normal
  double sqr_cos_beta_;
  float max_curvature_;
  Node* nodes_;
  std::int32_t* labels_;
  std::int8_t* signs_;
  std::uint8_t* on_border_;
  std::vector<Cluster>& clusters_;
  std::unique_ptr<pcl::index_t[]> queue_;
  std::size_t tail_ = 0;
  std::int32_t label_ = 0;
  Cluster cluster_;
  double threshold_ = 0.0;  ///< squared length that the sum must have along a candidate
};

}  // namespace

void grow(const SegmentationOptions& options, GrowthState& state) {
  const std::size_t n = state.nodes.size();
  state.labels.assign(n, -1);
  state.signs.assign(n, 1);
  state.on_border.assign(n, 1);
  SeedOrder seeds(state.nodes);
  Grower grower(options, state);
  seeds.forEachUnlabelled(state.labels, [&](std::size_t seed) { grower.grow(seed); });
}

}  // namespace segorient::segmentation
