// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "common/threads.h"
#include "features/one_sided_patch.h"
#include "features/recompute_scene.h"

namespace segorient::detail {
namespace {

using Side = OneSidedPatch::Side;

// Normals that differ by less than this (11 degrees) around a point need no second look.
const double kFlat = std::cos(0.2);
// One surface through everything around must fit this much worse than one side's surface: by more
// than such estimates of the same noise from some forty points differ.
constexpr double kWorse = 1.2;
// Standard deviations that a point may lie off the surface that it joins.
constexpr double kFarthestOff = 3.0;
// Beyond this a surface's height at the point is extrapolated guesswork.
constexpr double kLargestLeverage = 30.0;
// A point shares the patch of one of this many nearest: within that distance patches differ little.
constexpr int kPatchNeighbors = 12;
// Share of the points around, and of the points along the same border, that must see the edge as
// well: an edge is a line of points, and one that stands alone is noise or curvature.
constexpr double kAgreement = 0.5;
// Share of all points looked at that must see an edge. On solids with edges it is 0.65 to 0.95; on
// curved shapes, where segments meet smoothly and single folds mislead, 0.15 to 0.5.
constexpr double kEdgedShare = 0.55;
// Patches that the share is measured on: it is then known to a few hundredths.
constexpr std::size_t kSampledPatches = 512;
// Distances to the other face, in spacings, that tell whether points lie on the edges themselves:
// of points anywhere on two faces a twentieth of those within one spacing are within .05 (seen on
// clouds: .04 to .06), of the vertices of a mesh the row on the edge is (.33).
constexpr double kOnEdge = 0.05;
constexpr double kNearEdge = 1.0;
constexpr double kManyOnEdge = 0.2;
// Half a row of vertices: what is nearer belongs to the row on the edge.
constexpr double kHalfRow = 0.5;

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
  double to_other_face = std::numeric_limits<double>::infinity();  ///< in spacings
  std::vector<SeenBorder> borders;
};

/// One side as a point sees it.
struct SeenSide {
  const Side* side;
  SurfaceView view;
  double sigma;      ///< standard deviation of the point's height over the surface; never zero
  double center[3];  ///< of the side's points, from the point
};

double cosine(const SeenSide& a, const SeenSide& b) {
  double c = 0;
  for (int i = 0; i < 3; ++i) c += a.view.normal[i] * b.view.normal[i];
  return std::abs(c);
}

class OneSidedRule {
 public:
  OneSidedRule(const RecomputationScene& scene, const RecomputationOptions& options,
               OneSidedNormal which)
      : scene_(scene),
        patch_(scene),
        which_(which),
        edge_cosine_(std::cos(static_cast<double>(options.edge_angle))) {}

  void buildPatch(std::size_t middle) {
    middle_ = middle;
    patch_.build(middle);
  }

  /// Proposes a side for a point on the patch; accepted says whether it sees a sharp edge.
  void propose(std::size_t i, Proposal& proposal) {
    proposal.borders.clear();
    lookAtSides(i);
    const SeenSide* best = mostLikelySide();
    if (!best) return;
    const bool edge = std::any_of(sides_.begin(), sides_.end(), [&](const SeenSide& s) {
      return cosine(*best, s) < edge_cosine_;
    });
    proposal.result.accepted = edge && std::abs(best->view.height) <= kFarthestOff * best->sigma &&
                               oneSurfaceFitsWorse(best->side->fit);
    noteBorders(*best, proposal);
    if (!proposal.result.accepted) return;
    proposal.result.label = best->side->label;
    if (which_ == OneSidedNormal::EXPECTED) {
      setExpected(proposal.result.normal);
      proposal.to_other_face = distanceToOtherFace(*best) / spacingAt(i);
      return;
    }
    for (int a = 0; a < 3; ++a) {
      proposal.result.normal[a] = static_cast<float>(best->view.normal[a]);
    }
  }

 private:
  bool touches(std::size_t i, std::int32_t label) const {
    for (int j = 0; j < scene_.count(i); ++j) {
      if (scene_.labels[scene_.neighbor(i, j)] == label) return true;
    }
    return false;
  }

  void lookAtSides(std::size_t i) {
    sides_.clear();
    double offset[3];
    for (std::size_t a = 0; a < 3; ++a) {
      offset[a] =
          static_cast<double>(scene_.points[i][a]) - static_cast<double>(scene_.points[middle_][a]);
    }
    for (const Side& side : patch_.sides()) {
      if (!side.fit.valid() || !touches(i, side.label)) continue;
      SeenSide seen{};
      seen.side = &side;
      seen.view = side.fit.at(offset);
      if (side.label == scene_.labels[i]) leaveOut(seen.view);
      if (seen.view.leverage > kLargestLeverage) continue;
      seen.sigma = side.fit.rms() * std::sqrt(1.0 + seen.view.leverage) + 1e-3 * side.fit.reach();
      for (int a = 0; a < 3; ++a) seen.center[a] = side.fit.center()[a] - offset[a];
      sides_.push_back(seen);
    }
  }

  bool oneSurfaceFitsWorse(const OneSidedFit& best) {
    const OneSidedFit& whole = patch_.whole();
    return !whole.valid() || whole.rms() >= kWorse * best.rms();
  }

  /// As the surface would pass without the point itself, which is among those it was fitted to.
  static void leaveOut(SurfaceView& view) {
    const double rest = std::max(1.0 - view.leverage, 1e-3);
    view.height /= rest;
    view.leverage /= rest;
  }

  const SeenSide* mostLikelySide() const {
    const SeenSide* best = nullptr;
    double best_score = std::numeric_limits<double>::infinity();
    for (const SeenSide& side : sides_) {
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
  double unlikelihood(const SeenSide& side) const {
    const double off = side.view.height / side.sigma;
    double sum = 0.5 * off * off + std::log(side.sigma);
    for (const SeenSide& other : sides_) {
      if (&other == &side || cosine(side, other) > edge_cosine_) continue;
      double height = -other.view.height;
      for (int a = 0; a < 3; ++a) height += side.center[a] * other.view.normal[a];
      const double inside = height < 0.0 ? other.view.height : -other.view.height;
      sum -= logNormalCdf(inside / other.sigma);
    }
    return sum;
  }

  /// The mean of the sides' normals by the likelihoods, each turned as its own points are.
  void setExpected(float* normal) const {
    std::vector<double> scores;
    for (const SeenSide& side : sides_) scores.push_back(unlikelihood(side));
    const double least = *std::min_element(scores.begin(), scores.end());
    double sum[3] = {0, 0, 0};
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      const SeenSide& side = sides_[s];
      double along = 0;
      for (int a = 0; a < 3; ++a) along += side.side->toward[a] * side.view.normal[a];
      const double weight = std::copysign(std::exp(least - scores[s]), along);
      for (int a = 0; a < 3; ++a) sum[a] += weight * side.view.normal[a];
    }
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int a = 0; a < 3; ++a) normal[a] = static_cast<float>(sum[a] / length);
  }

  double distanceToOtherFace(const SeenSide& own) const {
    double least = std::numeric_limits<double>::infinity();
    for (const SeenSide& side : sides_) {
      if (cosine(own, side) < edge_cosine_) least = std::min(least, std::abs(side.view.height));
    }
    return least;
  }

  double spacingAt(std::size_t i) const {
    constexpr int kNearest = 6;
    const int count = std::min(scene_.count(i), kNearest + 1);
    double sum = 0;
    for (int j = 1; j < count; ++j) {
      double squares = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const double d = static_cast<double>(scene_.points[scene_.neighbor(i, j)][a]) -
                         static_cast<double>(scene_.points[i][a]);
        squares += d * d;
      }
      sum += std::sqrt(squares);
    }
    return sum / std::max(1, count - 1);
  }

  void noteBorders(const SeenSide& best, Proposal& proposal) const {
    for (const SeenSide& a : sides_) {
      for (const SeenSide& b : sides_) {
        if (!(a.side->label < b.side->label)) continue;
        const bool concerns = &a == &best || &b == &best;
        proposal.borders.push_back(
            {{a.side->label, b.side->label},
             concerns && proposal.result.accepted && cosine(a, b) < edge_cosine_});
      }
    }
  }

  const RecomputationScene& scene_;
  OneSidedPatch patch_;
  OneSidedNormal which_;
  double edge_cosine_;
  std::size_t middle_ = 0;
  std::vector<SeenSide> sides_;
};

/// What is known of a point while the votes are counted.
enum State : std::uint8_t { kUntouched, kExamined, kMiddle, kSharp };

/// A patch and the points that it serves: a range of the points looked at.
struct Patch {
  std::size_t middle = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The points to look at, patch by patch, and some patches spread evenly over the cloud.
struct Looks {
  std::vector<std::size_t> points;
  std::vector<Patch> patches;
  std::vector<std::size_t> sample;
};

std::vector<std::size_t> pointsAtBorders(const RecomputationScene& scene,
                                         std::vector<std::uint8_t>& state) {
  const auto size = static_cast<std::ptrdiff_t>(scene.size());
#pragma omp parallel for schedule(static) \
    num_threads(resolveThreads(scene.threads, scene.size(), 20.0))
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    const auto point = static_cast<std::size_t>(i);
    state[point] = scene.meetsBorder(point, kFlat) ? kExamined : kUntouched;
  }
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (state[i] == kExamined) points.push_back(i);
  }
  return points;
}

/// By coordinates, so that nothing depends on the order of the points.
std::vector<std::size_t> inOrderOfPlace(const RecomputationScene& scene,
                                        std::vector<std::size_t> points) {
  std::sort(points.begin(), points.end(), [&](std::size_t a, std::size_t b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float difference = scene.points[a][c] - scene.points[b][c];
      if (difference != 0.F) return difference < 0.F;
    }
    return a < b;
  });
  return points;
}

/// Greedily, each point becomes the middle of a patch that has none among its nearest.
Looks layPatches(const RecomputationScene& scene, std::vector<std::uint8_t>& state) {
  const auto middleNear = [&](std::size_t i) {
    const int count = std::min(scene.count(i), kPatchNeighbors + 1);
    for (int j = 0; j < count; ++j) {
      if (state[scene.neighbor(i, j)] == kMiddle) return scene.neighbor(i, j);
    }
    return scene.size();
  };
  const std::vector<std::size_t> examined = pointsAtBorders(scene, state);
  std::vector<std::size_t> middles;
  for (const std::size_t i : inOrderOfPlace(scene, examined)) {
    if (middleNear(i) < scene.size()) continue;
    state[i] = kMiddle;
    middles.push_back(i);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  pairs.reserve(examined.size());
  for (const std::size_t i : examined) pairs.emplace_back(middleNear(i), i);
  std::sort(pairs.begin(), pairs.end());

  Looks looks;
  looks.points.reserve(pairs.size());
  for (const auto& [middle, point] : pairs) {
    if (looks.patches.empty() || looks.patches.back().middle != middle) {
      looks.patches.push_back({middle, looks.points.size(), looks.points.size()});
    }
    looks.points.push_back(point);
    looks.patches.back().end = looks.points.size();
  }
  const std::size_t step = std::max<std::size_t>(1, middles.size() / kSampledPatches);
  for (std::size_t m = 0; m < middles.size(); m += step) {
    const auto at = std::lower_bound(
        looks.patches.begin(), looks.patches.end(), middles[m],
        [](const Patch& patch, std::size_t middle) { return patch.middle < middle; });
    looks.sample.push_back(static_cast<std::size_t>(at - looks.patches.begin()));
  }
  return looks;
}

/// Proposals for the points of some patches, in their order.
class Proposer {
 public:
  Proposer(const RecomputationScene& scene, const RecomputationOptions& options,
           OneSidedNormal which, const Looks& looks)
      : scene_(scene),
        options_(options),
        which_(which),
        looks_(looks),
        proposals_(looks.points.size()) {
    for (std::size_t r = 0; r < proposals_.size(); ++r) {
      proposals_[r].result.point = looks.points[r];
      proposals_[r].result.label = scene.labels[looks.points[r]];
    }
  }

  template <typename PatchAt>
  void run(std::size_t count, const PatchAt& patchAt) {
    const auto size = static_cast<std::ptrdiff_t>(count);
#pragma omp parallel num_threads(resolveThreads(scene_.threads, count, 20000.0))
    {
      OneSidedRule rule(scene_, options_, which_);
#pragma omp for schedule(dynamic, 16)
      for (std::ptrdiff_t p = 0; p < size; ++p) {
        const Patch& patch = looks_.patches[patchAt(static_cast<std::size_t>(p))];
        rule.buildPatch(patch.middle);
        for (std::size_t r = patch.begin; r < patch.end; ++r) {
          rule.propose(looks_.points[r], proposals_[r]);
        }
      }
    }
  }
  std::vector<Proposal>& proposals() {
    return proposals_;
  }

 private:
  const RecomputationScene& scene_;
  const RecomputationOptions& options_;
  OneSidedNormal which_;
  const Looks& looks_;
  std::vector<Proposal> proposals_;
};

/// Whether so many of the points of some patches see an edge that the cloud has edges at all.
bool seesEdges(const Looks& looks, const std::vector<Proposal>& proposals) {
  std::size_t sharp = 0;
  std::size_t all = 0;
  for (const std::size_t p : looks.sample) {
    for (std::size_t r = looks.patches[p].begin; r < looks.patches[p].end; ++r) {
      ++all;
      sharp += proposals[r].result.accepted ? 1 : 0;
    }
  }
  return static_cast<double>(sharp) >= kEdgedShare * static_cast<double>(all);
}

/// Whether the points include the edges themselves.
bool includeEdges(const std::vector<Proposal>& proposals) {
  std::size_t on = 0;
  std::size_t near = 0;
  for (const Proposal& p : proposals) {
    on += p.to_other_face < kOnEdge ? 1 : 0;
    near += p.to_other_face < kNearEdge ? 1 : 0;
  }
  return static_cast<double>(on) > kManyOnEdge * static_cast<double>(near);
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

/// What along each border saw it as sharp.
struct Votes {
  std::size_t all = 0;
  std::size_t sharp = 0;
};

/// Accepts what the points around and along the same border agree with.
std::vector<Recomputed> elect(const RecomputationScene& scene, bool edged,
                              const std::vector<Proposal>& proposals,
                              std::vector<std::uint8_t>& state) {
  std::map<std::pair<std::int32_t, std::int32_t>, Votes> votes;
  for (const Proposal& p : proposals) {
    if (p.result.accepted) state[p.result.point] = kSharp;
    for (const SeenBorder& border : p.borders) {
      Votes& v = votes[border.labels];
      ++v.all;
      v.sharp += border.sharp ? 1 : 0;
    }
  }
  std::vector<Recomputed> results;
  results.reserve(proposals.size());
  const bool on_edges = includeEdges(proposals);
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
    results.back().on_edge = results.back().accepted && on_edges && p.to_other_face < kHalfRow;
    if (results.back().on_edge) results.back().accepted = false;
  }
  return results;
}

}  // namespace

std::vector<Recomputed> applyOneSidedRule(const RecomputationScene& scene,
                                          const RecomputationOptions& options,
                                          OneSidedNormal which) {
  std::vector<std::uint8_t> state(scene.size());
  const Looks looks = layPatches(scene, state);
  Proposer proposer(scene, options, which, looks);
  proposer.run(looks.sample.size(), [&](std::size_t p) { return looks.sample[p]; });
  const std::vector<Proposal>& proposals = proposer.proposals();
  const bool edged = seesEdges(looks, proposals);
  if (edged) proposer.run(looks.patches.size(), [](std::size_t p) { return p; });
  return elect(scene, edged, proposals, state);
}

}  // namespace segorient::detail
