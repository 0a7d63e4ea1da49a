// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <cstring>

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

/// Seeds in the order of (curvature, index). Sorted by the upper half of the bits at first; the
/// points of one bucket are put in their exact order when growing comes to it and most of them are
/// taken.
class SeedOrder {
 public:
  explicit SeedOrder(const std::vector<Node>& nodes)
      : nodes_(nodes), starts_((1U << kBits) + 1, 0) {
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
      std::sort(begin, left, [&](pcl::index_t p, pcl::index_t q) {
        const std::uint32_t a = orderedBits(nodes_[static_cast<std::size_t>(p)].curvature);
        const std::uint32_t c = orderedBits(nodes_[static_cast<std::size_t>(q)].curvature);
        return a != c ? a < c : p < q;
      });
      for (auto it = begin; it != left; ++it) {
        if (labels[static_cast<std::size_t>(*it)] < 0) visit(static_cast<std::size_t>(*it));
      }
    }
  }

 private:
  static constexpr unsigned kBits = 16;

  static bool usable(const Node& p) { return std::isfinite(p.nx + p.ny + p.nz + p.x + p.y + p.z); }
  static std::size_t bucketOf(const Node& p) { return orderedBits(p.curvature) >> (32U - kBits); }

  const std::vector<Node>& nodes_;
  std::vector<std::size_t> starts_;
  std::vector<pcl::index_t> points_;
};

/// Grows one segment after the other; the queue is one array for all of them.
class Grower {
 public:
  Grower(const SegmentationOptions& options, GrowthState& state)
      : state_(state),
        cos_alpha_(options.alpha < kRightAngle ? std::cos(options.alpha) : 0.F),
        cos_beta_(options.beta < kRightAngle ? std::cos(options.beta) : -1.F),
        sqr_cos_beta_(static_cast<double>(cos_beta_) * static_cast<double>(cos_beta_)),
        max_curvature_(options.max_curvature) {}

  void grow(std::size_t seed) {
    label_ = static_cast<std::int32_t>(state_.clusters.size());
    cluster_ = Cluster{};
    queue_.clear();
    accept(seed, 1);
    for (std::size_t head = 0; head < queue_.size(); ++head) {
      if (head + kAhead < queue_.size()) {
        __builtin_prefetch(
            state_.neighborhoods->indices(static_cast<std::size_t>(queue_[head + kAhead])));
      }
      spread(static_cast<std::size_t>(queue_[head]));
    }
    state_.clusters.push_back(cluster_);
  }

 private:
  static constexpr std::size_t kAhead = 6;  ///< rows to fetch in advance
  static constexpr float kRightAngle = 1.5707963F;

  void accept(std::size_t q, int sign) {
    Node& node = state_.nodes[q];
    if (sign < 0) {
      node.nx = -node.nx;
      node.ny = -node.ny;
      node.nz = -node.nz;
    }
    state_.labels[q] = label_;
    state_.signs[q] = static_cast<std::int8_t>(sign);
    cluster_.normal.add(node);
    ++cluster_.size;
    threshold_ = sqr_cos_beta_ * cluster_.normal.squaredNorm();
    if (node.curvature > max_curvature_ && cluster_.size > 1) return;
    queue_.push_back(static_cast<pcl::index_t>(q));
  }

  void spread(std::size_t p) {
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int count = state_.rowSize(p);
    const Node node = state_.nodes[p];
    std::uint8_t border = 0;
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      if (state_.labels[q] == label_) continue;
      if (state_.labels[q] >= 0 || !tryAccept(node, q)) border = 1;
    }
    state_.on_border[p] = border;
  }

  // Without signs the angle to the neighbour is |cos|; the sign that it gives must also bring the
  // normal within beta of the reference.
  bool tryAccept(const Node& p, std::size_t q) {
    const Node& candidate = state_.nodes[q];
    const float cosine = dotNormals(p, candidate);
    if (!(std::abs(cosine) >= cos_alpha_) || !state_.limits.admissible(p, candidate)) return false;
    const int sign = cosine < 0.F ? -1 : 1;
    const double along = sign * cluster_.normal.dot(candidate);
    if (cos_beta_ > 0.F && !(along > 0.0 && along * along >= threshold_)) return false;
    accept(q, sign);
    return true;
  }

  GrowthState& state_;
  float cos_alpha_;
  float cos_beta_;  ///< negative = no condition on the reference normal
  double sqr_cos_beta_;
  float max_curvature_;
  std::int32_t label_ = 0;
  Cluster cluster_;
  double threshold_ = 0.0;  ///< squared length that the sum must have along a candidate
  std::vector<pcl::index_t> queue_;
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
