// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <Eigen/Dense>

#include <numeric>
#include <utility>

#include "common/threads.h"
#include "segmentation/distinct_points.h"
#include "segmentation/growth_state.h"

namespace segorient::segmentation {
namespace {

/// Surface patches that are looked at for one border: enough that noise averages out.
constexpr std::size_t kMostPatches = 128;
/// Points of a patch on each side, and on both: a quadratic surface has six coefficients.
constexpr int kLeastSide = 3;
constexpr int kLeastPatch = 12;
/// Share of the pairs across a border over which growing could have gone on but for beta, either
/// way.
constexpr double kShareWithin = 0.5;
/// Pairs of a border that is not smooth from which on it keeps its segments apart; where two
/// corners touch, some pairs mean little.
constexpr std::size_t kLeastSharp = 16;

/// Two neighbours in different segments; the first one's neighbours make up a patch.
struct Pair {
  std::int32_t a, b;  ///< segments, the smaller one first
  std::uint32_t p, q;
};

struct Border {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::size_t pairs = 0;
  bool smooth = false;
  bool flipped = false;  ///< whether the signs of the two disagree
};

/// Sums over a border's patches. In each, heights z over the tangent plane, x across the border and
/// y along it, are fitted by a quadratic surface and a kink |x|; the kink is common to all patches.
struct KinkSums {
  double kink_kink = 0;
  double kink_height = 0;
  double squares = 0;  ///< sum of the squared kinks of single patches, weighted
  double residual = 0;
  double freedom = 0;
  int patches = 0;
};

/// Tells smooth borders from sharp ones by the surface itself: the estimated normals lean over near
/// an edge, on a smooth surface and on a roof of 45 degrees by about as much.
class BorderTest {
 public:
  BorderTest(const SegmentationOptions& options, const GrowthState& state)
      : state_(state),
        cos_alpha_(std::cos(std::min(options.alpha, kRightAngle))),
        max_curvature_(options.max_curvature),
        max_residual_(scaledResidual(options, state)),
        most_slope_(std::tan(0.5 * static_cast<double>(std::min(options.alpha, kRightAngle)))) {}

  Border test(const Pair* begin, const Pair* end) {
    const auto pairs = static_cast<std::size_t>(end - begin);
    Border border{begin->a, begin->b, pairs};
    std::size_t within = 0;
    double agreement = 0;
    for (const Pair* pair = begin; pair != end; ++pair) {
      const Node& p = state_.nodes[pair->p];
      const Node& q = state_.nodes[pair->q];
      const float cosine = dotNormals(p, q);
      if (!(std::abs(cosine) >= cos_alpha_) || !state_.joins(pair->p, pair->q)) continue;
      if (!passesOn(p, q) || !passesOn(q, p)) continue;
      ++within;
      agreement += static_cast<double>(cosine);
    }
    if (static_cast<double>(within) < kShareWithin * static_cast<double>(pairs)) return border;
    border.flipped = agreement < 0;
    KinkSums sums = measure(begin, pairs, 2);
    if (isVague(sums)) sums = measure(begin, pairs, 3);
    border.smooth = isSmooth(sums);
    return border;
  }

 private:
  static constexpr float kRightAngle = 1.5707963F;

  KinkSums measure(const Pair* pairs, std::size_t count, int rings) {
    KinkSums sums;
    const std::size_t step = (count + kMostPatches - 1) / kMostPatches;
    for (std::size_t i = 0; i < count; i += step) addPatch(pairs[i], rings, sums);
    return sums;
  }

  // Whether noise turns a single patch by half of what is looked for.
  bool isVague(const KinkSums& sums) const {
    if (sums.patches == 0) return false;
    const double variance = sums.residual / sums.freedom;
    return variance * sums.patches > 0.25 * most_slope_ * most_slope_ * sums.kink_kink;
  }

  // The mean kink, and its root mean square less what noise makes of it: where a border is a ridge
  // here and a valley there, the mean alone says nothing.
  bool isSmooth(const KinkSums& sums) const {
    if (sums.patches == 0) return false;
    const double variance = sums.residual / sums.freedom;
    const double mean = sums.kink_height / sums.kink_kink;
    const double square = (sums.squares - sums.patches * variance) / sums.kink_kink;
    constexpr double kSpread = 2.0;  // of the estimate by a few patches
    return std::abs(mean) < most_slope_ && square < kSpread * most_slope_ * most_slope_;
  }

  void addPatch(const Pair& pair, int rings, KinkSums& sums) {
    listPatch(pair, rings);
    const Node& p = state_.nodes[pair.p];
    const Node& q = state_.nodes[pair.q];
    const Eigen::Vector3d middle = 0.5 * (position(p) + position(q));
    Eigen::Vector3d center_a = Eigen::Vector3d::Zero();
    Eigen::Vector3d center_b = Eigen::Vector3d::Zero();
    int count_a = 0;
    int count_b = 0;
    for (const pcl::index_t index : patch_) {
      const auto i = static_cast<std::size_t>(index);
      const bool in_a = state_.labels[i] == pair.a;
      (in_a ? center_a : center_b) += position(state_.nodes[i]) - middle;
      ++(in_a ? count_a : count_b);
    }
    if (count_a < kLeastSide || count_b < kLeastSide || count_a + count_b < kLeastPatch) return;
    // Heights have one sign along the whole border: that of the first segment's normals.
    const double sign = dotNormals(p, q) < 0.F ? -1.0 : 1.0;
    const bool p_in_a = state_.labels[pair.p] == pair.a;
    Eigen::Matrix3d frame;
    frame.col(2) =
        ((p_in_a ? 1.0 : sign) * normal(p) + (p_in_a ? sign : 1.0) * normal(q)).normalized();
    const Eigen::Vector3d across = center_b / count_b - center_a / count_a;
    frame.col(1) = frame.col(2).cross(across);
    if (!(frame.col(1).norm() > 0.1 * static_cast<double>(p.spacing)))
      return;  // one above the other
    frame.col(1).normalize();
    frame.col(0) = frame.col(1).cross(frame.col(2));
    Eigen::Matrix<double, 8, 8> products = Eigen::Matrix<double, 8, 8>::Zero();
    const Eigen::Matrix3d local = frame.transpose() / static_cast<double>(p.spacing);
    for (const pcl::index_t i : patch_) {
      const Eigen::Vector3d v =
          local * (position(state_.nodes[static_cast<std::size_t>(i)]) - middle);
      Eigen::Matrix<double, 8, 1> row;
      row << 1, v.x(), v.y(), v.x() * v.x(), v.x() * v.y(), v.y() * v.y(), std::abs(v.x()), v.z();
      products.selfadjointView<Eigen::Lower>().rankUpdate(row);
    }
    // What the quadratic surface leaves of the kink and of the heights.
    const Eigen::Matrix<double, 6, 6> quadratic =
        products.topLeftCorner<6, 6>().selfadjointView<Eigen::Lower>();
    const Eigen::Matrix<double, 2, 6> mixed = products.bottomLeftCorner<2, 6>();
    const Eigen::Matrix2d rest = products.bottomRightCorner<2, 2>() -
                                 mixed * quadratic.ldlt().solve(mixed.transpose().eval());
    // Points in rows say nothing about a kink.
    if (!(rest(0, 0) > 1e-6 * products(6, 6)) || !rest.allFinite()) return;
    const double explained = rest(1, 0) * rest(1, 0) / rest(0, 0);
    sums.kink_kink += rest(0, 0);
    sums.kink_height += rest(1, 0);
    sums.squares += explained;
    sums.residual += std::max(0.0, rest(1, 1) - explained);
    sums.freedom += count_a + count_b - 7;
    ++sums.patches;
  }

  // Whether growing that comes from p goes on at q.
  bool passesOn(const Node& p, const Node& q) const {
    return q.curvature <= max_curvature_ && residual(p, q) <= max_residual_;
  }

  // Points of the two segments among the neighbours' neighbours, and theirs in turn.
  void listPatch(const Pair& pair, int rings) {
    found_.restart();
    patch_.assign(1, static_cast<pcl::index_t>(pair.p));
    ring_ = patch_;
    for (int ring = 0; ring < rings; ++ring) {
      const std::size_t first = found_.size();
      for (const pcl::index_t p : ring_) addNear(static_cast<std::size_t>(p), pair);
      next_.assign(found_.begin() + first, found_.end());
      std::sort(next_.begin(), next_.end());
      next_.erase(std::unique(next_.begin(), next_.end()), next_.end());
      // Only what is new has the next ring around it.
      ring_.clear();
      std::set_difference(next_.begin(), next_.end(), patch_.begin(), patch_.end(),
                          std::back_inserter(ring_));
      next_.clear();
      std::merge(patch_.begin(), patch_.end(), ring_.begin(), ring_.end(),
                 std::back_inserter(next_));
      patch_.swap(next_);
    }
  }

  void addNear(std::size_t p, const Pair& pair) {
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int count = state_.rowSize(p);
    found_.reserve(static_cast<std::size_t>(count));
    for (int j = 0; j < count; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const std::int32_t label = state_.labels[q];
      found_.add(row[j], ((label == pair.a) | (label == pair.b)) &
                             state_.limits.near(state_.nodes[p], state_.nodes[q]));
    }
  }

  static Eigen::Vector3d position(const Node& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  }
  static Eigen::Vector3d normal(const Node& p) {
    return {static_cast<double>(p.nx), static_cast<double>(p.ny), static_cast<double>(p.nz)};
  }

  const GrowthState& state_;
  float cos_alpha_;
  float max_curvature_;
  float max_residual_;
  double most_slope_;
  DistinctPoints found_;
  std::vector<pcl::index_t> patch_;  ///< ascending
  std::vector<pcl::index_t> ring_, next_;
};

// Neighbours of the first ring in two regular segments, by border.
std::vector<Pair> collectPairs(const SegmentationOptions& options, const GrowthState& state) {
  std::vector<Pair> pairs;
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
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& s, const Pair& t) { return s.a != t.a ? s.a < t.a : s.b < t.b; });
  return pairs;
}

std::vector<Border> testBorders(const SegmentationOptions& options, const GrowthState& state) {
  const std::vector<Pair> pairs = collectPairs(options, state);
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i == 0 || pairs[i].a != pairs[i - 1].a || pairs[i].b != pairs[i - 1].b) starts.push_back(i);
  }
  std::vector<Border> borders(starts.size());
  starts.push_back(pairs.size());
  const auto count = static_cast<std::ptrdiff_t>(borders.size());
#pragma omp parallel num_threads(resolveThreads(options.threads, pairs.size(), 200.0))
  {
    BorderTest border_test(options, state);
#pragma omp for schedule(dynamic, 16)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      borders[at] = border_test.test(pairs.data() + starts[at], pairs.data() + starts[at + 1]);
    }
  }
  return borders;
}

/// Sets of segments that know whether a segment's signs disagree with its root's, and which others
/// they meet at a sharp border.
class SignedSets {
 public:
  explicit SignedSets(std::size_t size) : parent_(size), flipped_(size, 0), apart_(size) {
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
  void unite(const Border& border) {
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

}  // namespace

std::size_t uniteSmooth(const SegmentationOptions& options, GrowthState& state) {
  // What united segments would then hold is farther than alpha from any seed.
  if (options.compare_with_seed) return 0;
  SignedSets sets(state.clusters.size());
  std::vector<Border> smooth;
  for (const Border& border : testBorders(options, state)) {
    if (border.smooth) {
      smooth.push_back(border);
    } else if (border.pairs >= kLeastSharp) {
      sets.keepApart(border.a, border.b);
    }
  }
  if (smooth.empty()) return 0;
  // The longest first: they are the surest.
  std::stable_sort(smooth.begin(), smooth.end(),
                   [](const Border& s, const Border& t) { return s.pairs > t.pairs; });
  for (const Border& border : smooth) sets.unite(border);
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
