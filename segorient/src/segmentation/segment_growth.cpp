// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "common/compiler.h"
#include "segmentation/growth_state.h"
#include "segmentation/seed_order.h"

namespace segorient::segmentation {
namespace {

/// Edge policies of growing: which neighbours it may go on to from a point, and whether a segment
/// that wants one has support for it.

/// By distances and tangent planes, as PairLimits has them.
struct LimitedEdges {
  static constexpr bool kLooksAtRows = false;  ///< of candidates, before these are accepted
  PairLimits limits;

  std::uint32_t among(std::size_t /*p*/) const { return ~0U; }
  bool admits(const Node& p, const Node& q, std::size_t /*index*/) const {
    return limits.admissible(p, q);
  }
  bool supports(std::size_t /*q*/, std::int32_t /*label*/, std::uint32_t /*size*/) const {
    return true;
  }
};

/// Within single sheets, by SheetEdges.
struct ListedEdges {
  static constexpr bool kLooksAtRows = true;
  const GrowthState& state;
  const std::uint8_t* reliable;  ///< null = all points are

  std::uint32_t among(std::size_t p) const { return state.joined[p]; }
  bool admits(const Node& /*p*/, const Node& /*q*/, std::size_t index) const {
    return reliable == nullptr || reliable[index] != 0;
  }

  // As GrowthState::supports().
  bool supports(std::size_t q, std::int32_t label, std::uint32_t size) const {
    constexpr std::uint32_t kYoung = 6;  // a segment that small has not so many to offer
    const int wanted = size <= kYoung ? 0 : state.support;
    const std::uint32_t members = state.membersAmong(q, label);
    const int good = countBits(members & state.joined[q]);
    const int bad = countBits(members & ~state.joined[q]);
    return good >= wanted && (state.support == 0 || bad <= good);
  }
};

/// Grows one segment after the other; the queue is one array for all of them. The arrays are held
/// by plain pointers: this loop is most of the time that segmentation takes.
template <typename Edges>
class Grower {
 public:
  Grower(const SegmentationOptions& options, const Edges& edges, GrowthState& state,
         std::vector<std::uint8_t>& on_border)
      : hood_(*state.neighborhoods),
        edges_(edges),
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
        prefetch(hood_.indices(static_cast<std::size_t>(queue_[head + kRowsAhead])));
      }
      if (scattered_ && head + kLabelsAhead < tail_) {
        const auto p = static_cast<std::size_t>(queue_[head + kLabelsAhead]);
        const pcl::index_t* row = hood_.indices(p);
        for (int j = 1, end = rowSize(p); j < end; ++j) prefetch(labels_ + row[j]);
      }
      if (head + kNodesAhead < tail_) {
        const auto p = static_cast<std::size_t>(queue_[head + kNodesAhead]);
        const pcl::index_t* row = hood_.indices(p);
        for (int j = row_size_ / 2, end = rowSize(p); j < end; ++j) {
          prefetch(nodes_ + row[j]);
          if constexpr (Edges::kLooksAtRows) {
            const pcl::index_t* of_candidate = hood_.indices(static_cast<std::size_t>(row[j]));
            prefetch(of_candidate);
            prefetch(of_candidate + row_size_ - 1);
          }
        }
      }
      spread(static_cast<std::size_t>(queue_[head]));
    }
    clusters_.push_back(cluster_);
  }

  /// Goes on from the points that have neighbours in other segments or in none, in their order, and
  /// from what these reach.
  void growOn(std::size_t points) {
    tail_ = 0;
    for (std::size_t p = 0; p < points; ++p) {
      if (labels_[p] >= 0 && on_border_[p] != 0) queue_[tail_++] = static_cast<pcl::index_t>(p);
    }
    for (std::size_t head = 0; head < tail_; ++head) {
      const auto p = static_cast<std::size_t>(queue_[head]);
      label_ = labels_[p];
      cluster_ = clusters_[static_cast<std::size_t>(label_)];
      threshold_ = sqr_cos_beta_ * cluster_.normal.squaredNorm();
      spread(p);
      clusters_[static_cast<std::size_t>(label_)] = cluster_;
    }
  }

 private:
  static constexpr std::size_t kRowsAhead = 32;
  static constexpr std::size_t kLabelsAhead = 16;
  static constexpr std::size_t kNodesAhead = 12;
  static constexpr int kMaskBits = 32;

  // The table of counts is looked into only where it has something to tell.
  int rowSize(std::size_t p) const {
    return full_ ? row_size_ : std::min(hood_.count(p), row_size_);
  }

  void accept(std::size_t q, int sign, bool flat) {
    Node& node = nodes_[q];
    if (sign < 0) node.turn();
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
      const std::uint32_t here = ~0U >> (kMaskBits - (last - first));
      const std::uint32_t others =
          here & ~labelledAmong(labels_, row + first, last - first, label_);
      std::uint32_t open = others & edges_.among(p);
      if (open != others) border = 1;
      for (; open != 0; open &= open - 1) {
        const auto q = static_cast<std::size_t>(row[first + static_cast<int>(lowestBit(open))]);
        if (labels_[q] == label_) continue;  // twice in the row
        if (labels_[q] >= 0 || !tryAccept(node, q)) border = 1;
      }
    }
    on_border_[p] = border;
  }

  // Without signs the angle to the neighbour is |cos|; the sign that it gives must also bring the
  // normal within beta of the reference.
  bool tryAccept(const Node& p, std::size_t q) {
    const Node& candidate = nodes_[q];
    const float cosine = dotNormals(compare_with_seed_ ? seed_ : p, candidate);
    if (!(std::abs(cosine) >= cos_alpha_) || !edges_.admits(p, candidate, q)) return false;
    const int sign = cosine < 0.F ? -1 : 1;
    const double along = sign * cluster_.normal.dot(candidate);
    if (cos_beta_ > 0.F && !(along > 0.0 && along * along >= threshold_)) return false;
    if (!edges_.supports(q, label_, cluster_.size)) return false;
    accept(q, sign, residual(p, candidate) <= max_residual_);
    return true;
  }

  const Neighborhoods& hood_;
  const Edges& edges_;
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

// What is left to do after growing: the border, eight points at a time, as nearly all are not on
// it.
void end(const std::vector<std::uint8_t>& on_border, GrowthState& state) {
  state.strips.assign(state.clusters.size(), 0);
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

// Nothing is labelled. \return one a point: it may have a neighbour in another segment
std::vector<std::uint8_t> start(GrowthState& state) {
  const std::size_t n = state.nodes.size();
  state.labels.assign(n, -1);
  state.signs.assign(n, 1);
  return std::vector<std::uint8_t>(n, 1);
}

}  // namespace

void grow(const SegmentationOptions& options, GrowthState& state) {
  std::vector<std::uint8_t> on_border = start(state);
  SeedOrder seeds(state, options.threads);
  const LimitedEdges edges{state.limits};
  Grower<LimitedEdges> grower(options, edges, state, on_border);
  for (std::size_t seed = 0; seeds.next(seed);) grower.grow(seed);
  end(on_border, state);
}

void growSheets(const SegmentationOptions& options, GrowthState& state) {
  std::vector<std::uint8_t> on_border = start(state);
  const SheetEdges& sheets = *state.sheets;
  state.joined = sheets.list(*state.neighborhoods, options.threads);
  ListedEdges edges{state, sheets.field().reliable};
  Grower<ListedEdges> grower(options, edges, state, on_border);
  SeedOrder sure(state, options.threads, edges.reliable);
  for (std::size_t seed = 0; sure.next(seed);) grower.grow(seed);
  edges.reliable = nullptr;
  grower.growOn(state.nodes.size());
  SeedOrder rest(state, options.threads);
  for (std::size_t seed = 0; rest.next(seed);) grower.grow(seed);
  end(on_border, state);
}

}  // namespace segorient::segmentation
