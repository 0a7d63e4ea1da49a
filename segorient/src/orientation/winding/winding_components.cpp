// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/winding_components.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "common/box.h"
#include "common/parallel_for.h"
#include "orientation/winding/winding_number.h"
#include "search/index_of.h"

namespace segorient {
namespace {

// Each turn lowers the sum; a few rounds are the rule.
constexpr int kRounds = 20;

// One sample point that a component's field reaches, and the field there.
struct Reach {
  std::uint32_t sample;
  float w;
};

class Solver {
 public:
  Solver(const PointView& points, const float* dipoles, const float* spacing,
         const std::vector<std::int32_t>& components, std::size_t count, int threads)
      : points_(points),
        dipoles_(dipoles),
        spacing_(spacing),
        threads_(threads),
        rows_(count),
        boxes_(count),
        reach_(count) {
    std::vector<std::size_t> sizes(count, 0);
    for (const std::int32_t c : components) {
      if (c >= 0) ++sizes[static_cast<std::size_t>(c)];
    }
    for (std::size_t c = 0; c < count; ++c) rows_[c].reserve(sizes[c]);
    for (std::size_t i = 0; i < components.size(); ++i) {
      if (components[i] < 0) continue;
      const auto c = static_cast<std::size_t>(components[i]);
      rows_[c].push_back(static_cast<std::uint32_t>(i));
      boxes_[c].add(points[i]);
    }
  }

  std::vector<ComponentWinding> solve() {
    takeSamples();
    evaluateAll();
    insertOneByOne();
    // What came early did not know of what encloses it: a ball in its socket is a hollow sphere
    // until the body around them is there.
    std::vector<std::size_t> order(rows_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    turnInOrder(order, {});
    return results();
  }

  std::vector<std::int8_t> turnParts(std::size_t fixed, const TurnRule& rule) {
    windAsTurned();
    std::vector<std::pair<double, std::size_t>> by_gain;
    for (std::size_t c = fixed; c < rows_.size(); ++c) by_gain.emplace_back(-gain(c), c);
    std::sort(by_gain.begin(), by_gain.end());
    std::vector<std::size_t> order;
    for (const auto& [first_gain, c] : by_gain) order.push_back(c);
    turnInOrder(order, rule);
    return {signs_.begin(), signs_.end()};
  }

 private:
  // The field of all parts as they are turned now.
  void windAsTurned() {
    takeSamples();
    signs_.assign(rows_.size(), 1);
    evaluateAll();
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      for (const Reach& r : reach_[c]) field_[r.sample] += static_cast<double>(r.w);
    }
  }

  // Enough of each component to see it, and of the large ones in proportion.
  void takeSamples() {
    constexpr double kAll = 2000.0;
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      const auto& rows = rows_[c];
      const auto share = static_cast<std::size_t>(kAll * static_cast<double>(rows.size()) /
                                                  static_cast<double>(points_.size));
      const std::size_t want = std::min(rows.size(), std::max(kLeastSamples, share));
      for (std::size_t k = 0; k < want; ++k) {
        samples_.push_back(rows[k * rows.size() / want]);
        owner_.push_back(static_cast<std::uint32_t>(c));
        weight_.push_back(static_cast<double>(rows.size()) / static_cast<double>(want));
      }
    }
    field_.assign(samples_.size(), -0.5);
    std::vector<float> places;
    for (const std::uint32_t i : samples_) {
      places.insert(places.end(), points_[i], points_[i] + 3);
    }
    index_ = search::indexOf({places.data(), 3, samples_.size()}, threads_);
  }

  // One by one on all threads, and side by side where each is a small part of a thread's share.
  void evaluateAll() {
    constexpr double kPointTime = 200.0;  // ns, see resolveThreads()
    const auto threads = static_cast<std::size_t>(resolveThreads(threads_));
    std::vector<std::size_t> small;
    std::size_t in_small = 0;
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      if (8 * threads * rows_[c].size() > points_.size) {
        evaluate(c, threads_);
      } else {
        small.push_back(c);
        in_small += rows_[c].size();
      }
    }
    parallelFor(small.size(), threads_, timeOfEach(small.size(), in_small, kPointTime),
                [&](std::size_t s) { evaluate(small[s], 1); });
  }

  void evaluate(std::size_t c, int threads) {
    // For a WindingNumber, no rows are all points.
    if (rows_[c].empty()) return;
    WindingNumber winding;
    winding.build(points_, dipoles_, rows_[c], threads);
    auto& reach = reach_[c];
    const float margin = boxes_[c].diagonal();
    // A ball around the box with its margin, and around a single point.
    const float radius = 2.3F * margin + spacing_[rows_[c].front()];
    std::vector<pcl::index_t> near;
    std::vector<float> distances;
    index_.radius(boxes_[c].center().data(), static_cast<double>(radius), near, distances, 0,
                  false);
    std::sort(near.begin(), near.end());
    for (const pcl::index_t k : near) {
      const auto sample = static_cast<std::size_t>(k);
      if (!boxes_[c].contains(points_[samples_[sample]], margin)) continue;
      reach.push_back({static_cast<std::uint32_t>(sample), 0.F});
    }
    std::vector<float> places;
    std::vector<float> radii;
    for (const Reach& r : reach) {
      const std::uint32_t i = samples_[r.sample];
      places.insert(places.end(), points_[i], points_[i] + 3);
      radii.push_back(spacing_[i]);
    }
    const std::vector<float> w = winding.evaluate({places.data(), 3, reach.size()}, radii, threads);
    for (std::size_t r = 0; r < reach.size(); ++r) reach[r].w = w[r];
  }

  // The largest first, each with the sign that suits what is there already.
  void insertOneByOne() {
    signs_.assign(rows_.size(), 0);
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      double plus = 0.0;
      double minus = 0.0;
      for (const Reach& r : reach_[c]) {
        if (owner_[r.sample] > c) continue;
        const double f = field_[r.sample];
        const auto w = static_cast<double>(r.w);
        plus += weight_[r.sample] * (f + w) * (f + w);
        minus += weight_[r.sample] * (f - w) * (f - w);
      }
      signs_[c] = minus < plus ? -1 : 1;
      for (const Reach& r : reach_[c]) field_[r.sample] += signs_[c] * static_cast<double>(r.w);
    }
  }

  void turnInOrder(const std::vector<std::size_t>& order, const TurnRule& rule) {
    bool moved = true;
    for (int round = 0; round < kRounds && moved; ++round) {
      moved = false;
      for (const std::size_t c : order) {
        if (!gainsEnough(c, rule)) continue;
        flip(c);
        moved = true;
      }
    }
  }

  // What flipping a component would add to the sum of squares.
  double change(std::size_t c) const {
    double sum = 0.0;
    for (const Reach& r : reach_[c]) {
      const double t = signs_[c] * static_cast<double>(r.w);
      sum += weight_[r.sample] * 4.0 * t * (t - field_[r.sample]);
    }
    return sum;
  }

  void flip(std::size_t c) {
    for (const Reach& r : reach_[c]) {
      field_[r.sample] -= 2.0 * signs_[c] * static_cast<double>(r.w);
    }
    signs_[c] = -signs_[c];
  }

  double squaresAround(std::size_t c) const {
    double sum = 0.0;
    for (const Reach& r : reach_[c]) {
      sum += weight_[r.sample] * field_[r.sample] * field_[r.sample];
    }
    return sum;
  }

  // Mean square at the points of c itself, as it is or if it were turned over.
  double ownResidual(std::size_t c, bool turned) const {
    const double share = turned ? 2.0 * signs_[c] : 0.0;
    double squares = 0.0;
    double weights = 0.0;
    for (const Reach& r : reach_[c]) {
      if (owner_[r.sample] != c) continue;
      const double f = field_[r.sample] - share * static_cast<double>(r.w);
      squares += weight_[r.sample] * f * f;
      weights += weight_[r.sample];
    }
    return weights > 0.0 ? squares / weights : std::numeric_limits<double>::infinity();
  }

  // By what share flipping a part would lower the sum of squares around it.
  double gain(std::size_t c) const {
    const double share = -change(c) / (squaresAround(c) + 1e-12);
    return std::isfinite(share) ? share : 0.0;
  }

  bool gainsEnough(std::size_t c, const TurnRule& rule) const {
    const double share = gain(c);
    const double turned = ownResidual(c, true);
    // Of a closed surface that is alone and inside out it is 1, whatever open one it stands on.
    const bool inside_out = share > TurnRule{}.gain && ownResidual(c, false) >= 1.0;
    if (share > rule.gain && (turned <= rule.residual || inside_out)) return true;
    // Where other parts around are turned wrongly as well, and still are, less of the sum is
    // gained. A plane of random points has .07 with noise of a spacing.
    constexpr double kFits = 0.08;
    constexpr double kMisfits = 0.3;  // w is more than 1/2 off
    return share > 0.0 && turned <= std::min(kFits, rule.residual) &&
           ownResidual(c, false) > kMisfits;
  }

  std::vector<ComponentWinding> results() const {
    std::vector<ComponentWinding> out(rows_.size());
    std::vector<double> squares(rows_.size(), 0.0);
    std::vector<double> weights(rows_.size(), 0.0);
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      squares[owner_[k]] += weight_[k] * field_[k] * field_[k];
      weights[owner_[k]] += weight_[k];
    }
    for (std::size_t c = 0; c < out.size(); ++c) {
      out[c].sign = static_cast<std::int8_t>(signs_[c]);
      if (weights[c] <= 0.0) continue;
      out[c].residual = static_cast<float>(squares[c] / weights[c]);
      const double d = change(c);
      const double now = squaresAround(c);
      out[c].gain = static_cast<float>(std::max(0.0, d / weights[c]));
      out[c].evidence = static_cast<float>(std::max(0.0, d / (2.0 * now + d + 1e-12)));
    }
    return out;
  }

  const PointView& points_;
  const float* dipoles_;
  const float* spacing_;
  int threads_;
  std::vector<std::vector<std::uint32_t>> rows_;
  std::vector<Box> boxes_;
  std::vector<std::vector<Reach>> reach_;
  std::vector<std::uint32_t> samples_;
  search::MedianHashIndex index_;  // of the samples
  std::vector<std::uint32_t> owner_;
  std::vector<double> weight_;  // points that a sample stands for
  std::vector<double> field_;   // w - 1/2 at the samples
  std::vector<int> signs_;
};

}  // namespace

std::vector<std::int8_t> turnParts(const PointView& points, const float* dipoles,
                                   const float* spacing, const std::vector<std::int32_t>& parts,
                                   std::size_t count, std::size_t fixed, const TurnRule& rule,
                                   int threads) {
  if (count == 0) return {};
  return Solver(points, dipoles, spacing, parts, count, threads).turnParts(fixed, rule);
}

std::vector<ComponentWinding> solveComponents(const PointView& points, const float* dipoles,
                                              const float* spacing,
                                              const std::vector<std::int32_t>& components,
                                              std::size_t count, int threads) {
  if (count == 0) return {};
  return Solver(points, dipoles, spacing, components, count, threads).solve();
}

}  // namespace segorient
