// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <numeric>
#include <utility>

#include "common/parallel_for.h"
#include "segmentation/border_test.h"
#include "segmentation/growth_state.h"

namespace segorient::segmentation {
namespace {

/// Pairs of a border that is not smooth from which on it keeps its segments apart; where two
/// corners touch, some pairs mean little.
constexpr std::size_t kLeastSharp = 16;

// Sets of segments that know whether a segment's signs disagree with its root's, and which others
// they meet at a sharp border.
class SegmentSets {
 public:
  explicit SegmentSets(std::size_t size) : parent_(size), flipped_(size, 0), apart_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  std::pair<std::int32_t, bool> find(std::int32_t s) {
    std::int32_t root = s;
    bool flipped = false;
    for (; parent(root) != root; root = parent(root)) flipped ^= isFlipped(root);
    for (bool rest = flipped; parent(s) != root && s != root;) {
      const auto at = static_cast<std::size_t>(s);
      const bool next = rest ^ isFlipped(s);
      s = std::exchange(parent_[at], root);
      flipped_[at] = rest ? 1 : 0;
      rest = next;
    }
    return {root, flipped};
  }

  void keepApart(std::int32_t a, std::int32_t b) {
    apart_[static_cast<std::size_t>(a)].push_back(b);
    apart_[static_cast<std::size_t>(b)].push_back(a);
  }

  // A sliver on an edge that looks smooth towards both faces does not join them.
  void unite(const TestedBorder& border) {
    const auto [root_a, flipped_a] = find(border.a);
    const auto [root_b, flipped_b] = find(border.b);
    if (root_a == root_b || mustStayApart(root_a, root_b)) return;
    const auto root = static_cast<std::size_t>(std::min(root_a, root_b));
    const auto child = static_cast<std::size_t>(std::max(root_a, root_b));
    parent_[child] = static_cast<std::int32_t>(root);
    flipped_[child] = static_cast<std::uint8_t>((flipped_a != flipped_b) != border.flipped);
    if (apart_[root].size() < apart_[child].size()) apart_[root].swap(apart_[child]);
    apart_[root].insert(apart_[root].end(), apart_[child].begin(), apart_[child].end());
    apart_[child] = {};
  }

 private:
  std::int32_t parent(std::int32_t s) const { return parent_[static_cast<std::size_t>(s)]; }
  bool isFlipped(std::int32_t s) const { return flipped_[static_cast<std::size_t>(s)] != 0; }

  bool mustStayApart(std::int32_t root_a, std::int32_t root_b) {
    if (apart_[static_cast<std::size_t>(root_b)].size() <
        apart_[static_cast<std::size_t>(root_a)].size()) {
      std::swap(root_a, root_b);
    }
    const auto& others = apart_[static_cast<std::size_t>(root_a)];
    return std::any_of(others.begin(), others.end(),
                       [&](std::int32_t s) { return find(s).first == root_b; });
  }

  std::vector<std::int32_t> parent_;
  std::vector<std::uint8_t> flipped_;  ///< against the parent
  std::vector<std::vector<std::int32_t>> apart_;
};

// Neighbours of the first ring in two regular segments, by border.
std::vector<PointPair> collectPairs(const SegmentationOptions& options, const GrowthState& state) {
  std::vector<PointPair> pairs;
  for (const pcl::index_t index : state.border) {
    const auto p = static_cast<std::size_t>(index);
    const std::int32_t own = state.labels[p];
    if (!state.isFace(own, options.small_size)) continue;
    const pcl::index_t* row = state.neighborhoods->indices(p);
    const int count = std::min(state.rowSize(p), kRing + 1);
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const std::int32_t other = state.labels[q];
      if (other == own || other < 0 || !state.isFace(other, options.small_size)) continue;
      if (!state.limits.near(state.nodes[p], state.nodes[q])) continue;
      pairs.push_back({std::min(own, other), std::max(own, other), static_cast<std::uint32_t>(p),
                       static_cast<std::uint32_t>(q)});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const PointPair& s, const PointPair& t) {
    return s.a != t.a ? s.a < t.a : s.b < t.b;
  });
  return pairs;
}

std::vector<TestedBorder> testBorders(const SegmentationOptions& options,
                                      const GrowthState& state) {
  const std::vector<PointPair> pairs = collectPairs(options, state);
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i == 0 || pairs[i].a != pairs[i - 1].a || pairs[i].b != pairs[i - 1].b) starts.push_back(i);
  }
  std::vector<TestedBorder> borders(starts.size());
  starts.push_back(pairs.size());
  parallelFor(
      borders.size(), options.threads, timeOfEach(borders.size(), pairs.size(), 200.0),
      [&] { return BorderTest(options, state); },
      [&](std::size_t i, BorderTest& border_test) {
        borders[i] = border_test.test(pairs.data() + starts[i], pairs.data() + starts[i + 1]);
      });
  return borders;
}

}  // namespace

std::size_t uniteSmooth(const SegmentationOptions& options, GrowthState& state) {
  // What united segments would then hold is farther than alpha from any seed.
  if (options.compare_with_seed) return 0;
  SegmentSets sets(state.clusters.size());
  std::vector<TestedBorder> smooth;
  for (const TestedBorder& border : testBorders(options, state)) {
    if (border.smooth) {
      smooth.push_back(border);
    } else if (border.pairs >= kLeastSharp) {
      sets.keepApart(border.a, border.b);
    }
  }
  if (smooth.empty()) return 0;
  // The longest first: they are the surest.
  std::stable_sort(smooth.begin(), smooth.end(),
                   [](const TestedBorder& s, const TestedBorder& t) { return s.pairs > t.pairs; });
  for (const TestedBorder& border : smooth) sets.unite(border);
  std::size_t united = 0;
  std::vector<std::pair<std::int32_t, bool>> roots(state.clusters.size());
  for (std::size_t s = 0; s < state.clusters.size(); ++s) {
    const auto [root, flipped] = roots[s] = sets.find(static_cast<std::int32_t>(s));
    if (root == static_cast<std::int32_t>(s)) continue;
    Cluster& into = state.clusters[static_cast<std::size_t>(root)];
    into.normal.add(state.clusters[s].normal, flipped ? -1.0 : 1.0);
    into.size += state.clusters[s].size;
    state.clusters[s] = Cluster{};
    ++united;
  }
  for (std::size_t p = 0; p < state.labels.size(); ++p) {
    if (state.labels[p] < 0) continue;
    const auto [root, flipped] = roots[static_cast<std::size_t>(state.labels[p])];
    state.labels[p] = root;
    if (flipped) state.signs[p] = static_cast<std::int8_t>(-state.signs[p]);
  }
  return united;
}

}  // namespace segorient::segmentation
