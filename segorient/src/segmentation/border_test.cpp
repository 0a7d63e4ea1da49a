// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/border_test.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>

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

Eigen::Vector3d position(const Node& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

Eigen::Vector3d normal(const Node& p) {
  return {static_cast<double>(p.nx), static_cast<double>(p.ny), static_cast<double>(p.nz)};
}

}  // namespace

BorderTest::BorderTest(const SegmentationOptions& options, const GrowthState& state)
    : state_(state),
      cos_alpha_(cosineOf(options.alpha)),
      max_curvature_(options.max_curvature),
      max_residual_(scaledResidual(options, state)),
      most_slope_(std::tan(0.5 * static_cast<double>(std::min(options.alpha, kRightAngle)))) {}

TestedBorder BorderTest::test(const PointPair* begin, const PointPair* end) {
  const auto pairs = static_cast<std::size_t>(end - begin);
  TestedBorder border{begin->a, begin->b, pairs};
  std::size_t within = 0;
  double agreement = 0;
  for (const PointPair* pair = begin; pair != end; ++pair) {
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

BorderTest::KinkSums BorderTest::measure(const PointPair* pairs, std::size_t count, int rings) {
  KinkSums sums;
  const std::size_t step = (count + kMostPatches - 1) / kMostPatches;
  for (std::size_t i = 0; i < count; i += step) addPatch(pairs[i], rings, sums);
  return sums;
}

// Whether noise turns a single patch by half of what is looked for.
bool BorderTest::isVague(const KinkSums& sums) const {
  if (sums.patches == 0) return false;
  const double variance = sums.residual / sums.freedom;
  return variance * sums.patches > 0.25 * most_slope_ * most_slope_ * sums.kink_kink;
}

// The mean kink, and its root mean square less what noise makes of it: where a border is a ridge
// here and a valley there, the mean alone says nothing.
bool BorderTest::isSmooth(const KinkSums& sums) const {
  if (sums.patches == 0) return false;
  const double variance = sums.residual / sums.freedom;
  const double mean = sums.kink_height / sums.kink_kink;
  const double square = (sums.squares - sums.patches * variance) / sums.kink_kink;
  constexpr double kSpread = 2.0;  // of the estimate by a few patches
  return std::abs(mean) < most_slope_ && square < kSpread * most_slope_ * most_slope_;
}

// A frame at the middle of a pair, in spacings: x across the border, y along it, z the normal;
// false where the patch is too small on one side, or the two sides lie one above the other. Heights
// have one sign along the whole border: that of the first segment's normals.
bool BorderTest::setFrame(const PointPair& pair, const Eigen::Vector3d& middle,
                          Eigen::Matrix3d& frame) const {
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
  if (count_a < kLeastSide || count_b < kLeastSide || count_a + count_b < kLeastPatch) return false;
  const Node& p = state_.nodes[pair.p];
  const Node& q = state_.nodes[pair.q];
  const double sign = dotNormals(p, q) < 0.F ? -1.0 : 1.0;
  const bool p_in_a = state_.labels[pair.p] == pair.a;
  frame.col(2) =
      ((p_in_a ? 1.0 : sign) * normal(p) + (p_in_a ? sign : 1.0) * normal(q)).normalized();
  const Eigen::Vector3d across = center_b / count_b - center_a / count_a;
  frame.col(1) = frame.col(2).cross(across);
  if (!(frame.col(1).norm() > 0.1 * static_cast<double>(p.spacing))) return false;
  frame.col(1).normalize();
  frame.col(0) = frame.col(1).cross(frame.col(2));
  return true;
}

void BorderTest::addPatch(const PointPair& pair, int rings, KinkSums& sums) {
  listPatch(pair, rings);
  const Node& p = state_.nodes[pair.p];
  const Eigen::Vector3d middle = 0.5 * (position(p) + position(state_.nodes[pair.q]));
  Eigen::Matrix3d frame;
  if (!setFrame(pair, middle, frame)) return;
  Matrix8 products = Matrix8::Zero();
  const Eigen::Matrix3d local = frame.transpose() / static_cast<double>(p.spacing);
  for (const pcl::index_t i : patch_) {
    const Eigen::Vector3d v =
        local * (position(state_.nodes[static_cast<std::size_t>(i)]) - middle);
    Eigen::Matrix<double, 8, 1> row;
    row << 1, v.x(), v.y(), v.x() * v.x(), v.x() * v.y(), v.y() * v.y(), std::abs(v.x()), v.z();
    products.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  sums.add(products, static_cast<double>(patch_.size()));
}

// What the quadratic surface leaves of the kink and of the heights.
void BorderTest::KinkSums::add(const Matrix8& products, double points) {
  const Eigen::Matrix<double, 6, 6> quadratic =
      products.topLeftCorner<6, 6>().selfadjointView<Eigen::Lower>();
  const Eigen::Matrix<double, 2, 6> mixed = products.bottomLeftCorner<2, 6>();
  const Eigen::Matrix2d rest =
      products.bottomRightCorner<2, 2>() - mixed * quadratic.ldlt().solve(mixed.transpose().eval());
  // Points in rows say nothing about a kink.
  if (!(rest(0, 0) > 1e-6 * products(6, 6)) || !rest.allFinite()) return;
  const double explained = rest(1, 0) * rest(1, 0) / rest(0, 0);
  kink_kink += rest(0, 0);
  kink_height += rest(1, 0);
  squares += explained;
  residual += std::max(0.0, rest(1, 1) - explained);
  freedom += points - 7;
  ++patches;
}

// Whether growing that comes from p goes on at q.
bool BorderTest::passesOn(const Node& p, const Node& q) const {
  return q.curvature <= max_curvature_ && residual(p, q) <= max_residual_;
}

// Points of the two segments among the neighbours' neighbours, and theirs in turn.
void BorderTest::listPatch(const PointPair& pair, int rings) {
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
    std::merge(patch_.begin(), patch_.end(), ring_.begin(), ring_.end(), std::back_inserter(next_));
    patch_.swap(next_);
  }
}

void BorderTest::addNear(std::size_t p, const PointPair& pair) {
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

}  // namespace segorient::segmentation
