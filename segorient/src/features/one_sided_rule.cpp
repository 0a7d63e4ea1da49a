// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "one_sided_fit.h"
#include "point_set.h"
#include "recompute_scene.h"

namespace segorient::detail {
namespace {

// Points of one segment that a surface is fitted to: some five for each coefficient, so that noise
// of a quarter of the spacing averages out.
constexpr std::size_t kMostPoints = 28;
// Normals that differ by less than this (11 degrees) around a point need no second look.
const double kFlat = std::cos(0.2);
// One surface through everything around must fit this much worse than one side's surface.
constexpr double kWorse = 1.5;
// Standard deviations that a point may lie off the surface that it joins.
constexpr double kFarthestOff = 3.0;
// Beyond this a surface's height at the point is extrapolated guesswork.
constexpr double kLargestLeverage = 30.0;
// Share of the points around, and of the points along the same border, that must see the edge as
// well: an edge is a line of points, and one that stands alone is noise or curvature.
constexpr double kAgreement = 0.5;

// Share of all points looked at that must see an edge. On solids with edges it is 0.5 to 0.9; on
// curved shapes, where segments meet smoothly and single folds mislead, 0.1 to 0.3.
constexpr double kEdgedShare = 0.4;

double logNormalCdf(double x) {
  return std::log(std::max(0.5 * std::erfc(-x * M_SQRT1_2), 1e-30));
}

/// Two segments near a point, and whether it saw a sharp edge between them.
struct SeenBorder {
  std::pair<std::int32_t, std::int32_t> labels;
  bool sharp = false;
};

struct Proposal {
  Recomputed result;
  std::vector<SeenBorder> borders;
};

/// One segment near a point.
struct Side {
  std::int32_t label = -1;
  OneSidedFit fit;
  double center[3] = {0, 0, 0};  ///< of its nearest points
};

double cosine(const Side& a, const Side& b) {
  double c = 0;
  for (int i = 0; i < 3; ++i) c += a.fit.normal[i] * b.fit.normal[i];
  return std::abs(c);
}

/// Standard deviation of a point's height over the surface; never zero, so that ratios exist on
/// noiseless clouds.
double sigma(const OneSidedFit& f) {
  return f.rms * std::sqrt(1.0 + f.leverage) + 1e-3 * f.reach;
}

class OneSidedRule {
 public:
  OneSidedRule(const RecomputationScene& scene, const RecomputationOptions& options)
      : scene_(scene), edge_cosine_(std::cos(static_cast<double>(options.edge_angle))) {}

  /// Proposes a side for the point; accepted says whether it sees a sharp edge.
  void propose(std::size_t i, Proposal& proposal) {
    proposal.result.label = scene_.labels[i];
    findSides(i);
    if (sides_.empty()) return;
    collect(i);
    for (Side& side : sides_) fitSide(side);
    const Side* best = mostLikelySide();
    if (!best) return;
    const bool edge = std::any_of(sides_.begin(), sides_.end(), [&](const Side& s) {
      return s.fit.valid && cosine(*best, s) < edge_cosine_;
    });
    proposal.result.accepted = edge &&
                               std::abs(best->fit.height) <= kFarthestOff * sigma(best->fit) &&
                               oneSurfaceFitsWorse(best->fit);
    noteBorders(*best, proposal);
    if (!proposal.result.accepted) return;
    proposal.result.label = best->label;
    for (int a = 0; a < 3; ++a) {
      proposal.result.normal[a] = static_cast<float>(best->fit.normal[a]);
    }
  }

 private:
  struct Candidate {
    NearPoint point;
    std::int32_t label;
    std::size_t index;
  };

  void findSides(std::size_t i) {
    sides_.clear();
    for (int j = 0; j < scene_.count(i); ++j) {
      const std::int32_t label = scene_.labels[scene_.neighbor(i, j)];
      const bool known = std::any_of(sides_.begin(), sides_.end(),
                                     [&](const Side& s) { return s.label == label; });
      if (known || !scene_.isRegular(label)) continue;
      sides_.emplace_back();
      sides_.back().label = label;
    }
  }

  /// The neighbours and their neighbours, the point itself left out, by distance.
  void collect(std::size_t i) {
    seen_.clear();
    seen_.insert(i);
    near_.clear();
    const float* p = scene_.points[i];
    for (int j = 0; j < scene_.count(i); ++j) {
      const std::size_t q = scene_.neighbor(i, j);
      for (int k = 0; k < scene_.count(q); ++k) {
        const std::size_t r = scene_.neighbor(q, k);
        if (!seen_.insert(r)) continue;
        NearPoint point{};
        for (int a = 0; a < 3; ++a) {
          point.offset[a] = static_cast<double>(scene_.points[r][a]) - static_cast<double>(p[a]);
          point.sqr_distance += point.offset[a] * point.offset[a];
        }
        near_.push_back({point, scene_.labels[r], r});
      }
    }
    order_.clear();
    for (std::size_t c = 0; c < near_.size(); ++c) {
      order_.emplace_back(near_[c].point.sqr_distance, c);
    }
    std::sort(order_.begin(), order_.end(), [&](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : near_[a.second].index < near_[b.second].index;
    });
  }

  template <typename Accept>
  OneSidedFit fitNearest(const Accept& accept) {
    chosen_.clear();
    for (const auto& [distance, at] : order_) {
      if (chosen_.size() == kMostPoints) break;
      if (accept(near_[at].label)) chosen_.push_back(near_[at].point);
    }
    return fitOneSided(chosen_.data(), chosen_.size());
  }

  void fitSide(Side& side) {
    side.fit = fitNearest([&](std::int32_t label) { return label == side.label; });
    if (side.fit.leverage > kLargestLeverage) side.fit.valid = false;
    const std::size_t nearest = std::min<std::size_t>(chosen_.size(), 6);
    for (std::size_t j = 0; j < nearest; ++j) {
      for (int a = 0; a < 3; ++a) {
        side.center[a] += chosen_[j].offset[a] / static_cast<double>(nearest);
      }
    }
  }

  const Side* mostLikelySide() const {
    const Side* best = nullptr;
    double best_score = std::numeric_limits<double>::infinity();
    for (const Side& side : sides_) {
      if (!side.fit.valid) continue;
      const double score = unlikelihood(side);
      if (score >= best_score) continue;
      best_score = score;
      best = &side;
    }
    return best;
  }

  /// Negative logarithm of the likelihood that the point belongs to the side: that noise put it so
  /// far off this surface, and that it lies on that side of every other surface where this
  /// segment's points lie. The latter settles what distances alone leave open near the edge itself.
  double unlikelihood(const Side& side) const {
    const double off = side.fit.height / sigma(side.fit);
    double sum = 0.5 * off * off + std::log(sigma(side.fit));
    for (const Side& other : sides_) {
      if (&other == &side || !other.fit.valid || cosine(side, other) > edge_cosine_) continue;
      double height = -other.fit.height;
      for (int a = 0; a < 3; ++a) height += side.center[a] * other.fit.normal[a];
      const double inside = height < 0.0 ? other.fit.height : -other.fit.height;
      sum -= logNormalCdf(inside / sigma(other.fit));
    }
    return sum;
  }

  bool oneSurfaceFitsWorse(const OneSidedFit& best) {
    const OneSidedFit all = fitNearest([](std::int32_t) { return true; });
    return !all.valid || all.rms >= kWorse * best.rms;
  }

  void noteBorders(const Side& best, Proposal& proposal) const {
    for (const Side& a : sides_) {
      for (const Side& b : sides_) {
        if (!(a.label < b.label) || !a.fit.valid || !b.fit.valid) continue;
        const bool concerns = &a == &best || &b == &best;
        proposal.borders.push_back(
            {{a.label, b.label},
             concerns && proposal.result.accepted && cosine(a, b) < edge_cosine_});
      }
    }
  }

  const RecomputationScene& scene_;
  double edge_cosine_;
  std::vector<Side> sides_;
  PointSet seen_;
  std::vector<Candidate> near_;
  std::vector<std::pair<double, std::size_t>> order_;  ///< into near_, by distance
  std::vector<NearPoint> chosen_;
};

/// What is known of a point while the votes are counted.
enum State : std::uint8_t { kUntouched, kExamined, kSharp };

std::vector<Proposal> examine(const RecomputationScene& scene, const RecomputationOptions& options,
                              std::vector<std::uint8_t>& state) {
  const auto size = static_cast<std::ptrdiff_t>(scene.size());
#pragma omp parallel for schedule(static) num_threads(scene.threads)
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    const auto point = static_cast<std::size_t>(i);
    state[point] = scene.meetsBorder(point, kFlat) ? kExamined : kUntouched;
  }
  std::vector<Proposal> proposals;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (state[i] != kExamined) continue;
    proposals.emplace_back();
    proposals.back().result.point = i;
  }
  const auto examined = static_cast<std::ptrdiff_t>(proposals.size());
#pragma omp parallel num_threads(scene.threads)
  {
    OneSidedRule rule(scene, options);
#pragma omp for schedule(dynamic, 64)
    for (std::ptrdiff_t r = 0; r < examined; ++r) {
      Proposal& proposal = proposals[static_cast<std::size_t>(r)];
      rule.propose(proposal.result.point, proposal);
      if (proposal.result.accepted) state[proposal.result.point] = kSharp;
    }
  }
  return proposals;
}

bool neighborsAgree(const RecomputationScene& scene, const std::vector<std::uint8_t>& state,
                    std::size_t i) {
  int examined = 0;
  int sharp = 0;
  for (int j = 0; j < scene.count(i); ++j) {
    const std::uint8_t s = state[scene.neighbor(i, j)];
    examined += s != kUntouched ? 1 : 0;
    sharp += s == kSharp ? 1 : 0;
  }
  return sharp >= kAgreement * examined;
}

}  // namespace

std::vector<Recomputed> applyOneSidedRule(const RecomputationScene& scene,
                                          const RecomputationOptions& options) {
  std::vector<std::uint8_t> state(scene.size());
  const std::vector<Proposal> proposals = examine(scene, options, state);

  const auto sharp = static_cast<double>(std::count(state.begin(), state.end(), kSharp));
  const bool edged = sharp >= kEdgedShare * static_cast<double>(proposals.size());

  struct Votes {
    std::size_t all = 0;
    std::size_t sharp = 0;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Votes> votes;
  for (const Proposal& p : proposals) {
    for (const SeenBorder& border : p.borders) {
      Votes& v = votes[border.labels];
      ++v.all;
      v.sharp += border.sharp ? 1 : 0;
    }
  }
  std::vector<Recomputed> results;
  results.reserve(proposals.size());
  for (const Proposal& p : proposals) {
    results.push_back(p.result);
    if (!p.result.accepted) continue;
    const bool border_agrees =
        std::any_of(p.borders.begin(), p.borders.end(), [&](const SeenBorder& border) {
          const Votes& v = votes[border.labels];
          return border.sharp &&
                 static_cast<double>(v.sharp) >= kAgreement * static_cast<double>(v.all);
        });
    results.back().accepted =
        edged && border_agrees && neighborsAgree(scene, state, p.result.point);
  }
  return results;
}

}  // namespace segorient::detail
