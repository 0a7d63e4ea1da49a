// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "common/threads.h"
#include "features/one_sided_view.h"
#include "features/recompute_scene.h"

namespace segorient::detail {
namespace {

// Normals that differ by less than this (11 degrees) around a point need no second look.
const double kFlat = std::cos(0.2);
// A point shares the patch of one of this many nearest: within that distance patches differ little.
constexpr int kPatchNeighbors = 12;
// Share of the points around, of the points along the same border, and of all points looked at,
// that must see the edge as well: an edge is a line of points, and one that stands alone is noise
// or curvature.
constexpr double kAgreement = 0.5;
// Neighbours of the smallest surfaces that estimates without noise are made of.
constexpr int kSmoothNeighbors = 10;
// Patches that shares of all points are measured on: they are then known to a few hundredths.
constexpr std::size_t kSampledPatches = 512;
// Distances to the other face, in spacings, that tell whether points lie on the edges themselves:
// of points anywhere on two faces a twentieth of those within one spacing are within .05 (seen on
// clouds: .04 to .06), of the vertices of a mesh the row on the edge is (.33).
constexpr double kOnEdge = 0.05;
constexpr double kNearEdge = 1.0;
constexpr double kManyOnEdge = 0.2;
// Half a row of vertices: what is nearer belongs to the row on the edge.
constexpr double kHalfRow = 0.5;

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
                                        const std::vector<std::size_t>& points) {
  std::vector<std::pair<std::array<float, 3>, std::size_t>> places;
  places.reserve(points.size());
  for (const std::size_t i : points) {
    const float* p = scene.points[i];
    places.push_back({{p[0], p[1], p[2]}, i});
  }
  std::sort(places.begin(), places.end());
  std::vector<std::size_t> out;
  out.reserve(places.size());
  for (const auto& [place, i] : places) out.push_back(i);
  return out;
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
  std::vector<std::uint64_t> pairs;  // middle above, point below
  pairs.reserve(examined.size());
  for (const std::size_t i : examined) pairs.push_back(std::uint64_t{middleNear(i)} << 32U | i);
  std::sort(pairs.begin(), pairs.end());

  Looks looks;
  looks.points.reserve(pairs.size());
  for (const std::uint64_t pair : pairs) {
    const auto middle = static_cast<std::size_t>(pair >> 32U);
    const auto point = static_cast<std::size_t>(pair & 0xffffffffU);
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

/// What the rule looked at in one round, and by which labels.
struct Round {
  Looks looks;
  std::vector<Proposal> proposals;  // by the points looked at
  std::vector<std::uint8_t> known;  // by patch: not 0 where there are proposals
  std::vector<std::int32_t> labels;
};

/// Proposals for the points of some patches, in their order. Where no label has changed since the
/// round before, its proposals stay: the surfaces on both sides are the same, but for which way
/// their points' normals faced then.
class Proposer {
 public:
  Proposer(const RecomputationScene& scene, const RecomputationOptions& options,
           OneSidedNormal which, Round& before, Round& now)
      : scene_(scene), options_(options), which_(which), before_(before), now_(now) {
    now_.known.assign(now_.looks.patches.size(), 0);
    now_.proposals.resize(now_.looks.points.size());
    for (std::size_t r = 0; r < now_.proposals.size(); ++r) {
      now_.proposals[r].result.point = now_.looks.points[r];
      now_.proposals[r].result.label = scene.labels[now_.looks.points[r]];
    }
  }

  template <typename PatchAt>
  void run(std::size_t count, const PatchAt& patchAt) {
    const auto size = static_cast<std::ptrdiff_t>(count);
#pragma omp parallel num_threads(resolveThreads(scene_.threads, count, 20000.0))
    {
      OneSidedView view(scene_, options_, which_);
#pragma omp for schedule(dynamic, 16)
      for (std::ptrdiff_t p = 0; p < size; ++p) {
        const std::size_t at = patchAt(static_cast<std::size_t>(p));
        if (now_.known[at] == 0 && !takeOver(at)) propose(now_.looks.patches[at], view);
        now_.known[at] = 1;
      }
    }
  }

 private:
  void propose(const Patch& patch, OneSidedView& view) {
    view.buildPatch(patch.middle);
    for (std::size_t r = patch.begin; r < patch.end; ++r) {
      view.propose(now_.looks.points[r], now_.proposals[r]);
    }
  }

  bool takeOver(std::size_t at) {
    const Patch& patch = now_.looks.patches[at];
    const std::vector<Patch>& patches = before_.looks.patches;
    const auto same =
        std::lower_bound(patches.begin(), patches.end(), patch.middle,
                         [](const Patch& p, std::size_t middle) { return p.middle < middle; });
    if (same == patches.end() || same->middle != patch.middle) return false;
    if (before_.known[static_cast<std::size_t>(same - patches.begin())] == 0) return false;
    const auto begin = now_.looks.points.begin();
    const auto begin_before = before_.looks.points.begin();
    const auto offset = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
    if (!std::equal(begin + offset(patch.begin), begin + offset(patch.end),
                    begin_before + offset(same->begin), begin_before + offset(same->end)) ||
        hasChanged(patch)) {
      return false;
    }
    std::move(before_.proposals.begin() + offset(same->begin),
              before_.proposals.begin() + offset(same->end),
              now_.proposals.begin() + offset(patch.begin));
    return true;
  }

  // Whether a label has that a patch or one of its points looks at.
  bool hasChanged(const Patch& patch) const {
    for (int j = 0; j < scene_.count(patch.middle); ++j) {
      if (changesAround(scene_.neighbor(patch.middle, j))) return true;
    }
    return std::any_of(now_.looks.points.begin() + static_cast<std::ptrdiff_t>(patch.begin),
                       now_.looks.points.begin() + static_cast<std::ptrdiff_t>(patch.end),
                       [&](std::size_t i) { return changesAround(i); });
  }
  bool changesAround(std::size_t i) const {
    for (int j = 0; j < scene_.count(i); ++j) {
      const std::size_t q = scene_.neighbor(i, j);
      if (scene_.labels[q] != before_.labels[q]) return true;
    }
    return false;
  }

  const RecomputationScene& scene_;
  const RecomputationOptions& options_;
  OneSidedNormal which_;
  Round& before_;
  Round& now_;
};

/// How far a point lies off one smooth surface through its nearest neighbours, whatever their
/// segment, which is not fitted to the point itself.
double offSmoothSurface(const RecomputationScene& scene, std::size_t i) {
  std::array<NearPoint, kSmoothNeighbors> near{};
  std::size_t count = 0;
  for (int j = 1; j < scene.count(i) && count < near.size(); ++j) {
    NearPoint& q = near[count++];
    for (std::size_t a = 0; a < 3; ++a) {
      q.offset[a] = static_cast<double>(scene.points[scene.neighbor(i, j)][a]) -
                    static_cast<double>(scene.points[i][a]);
      q.sqr_distance += q.offset[a] * q.offset[a];
    }
  }
  OneSidedFit smooth;
  smooth.fit(near.data(), count);
  const std::array<double, 3> point{};
  return smooth.valid() ? std::abs(smooth.at(point.data()).height)
                        : std::numeric_limits<double>::infinity();
}

/// Whether the cloud has edges at all: most points of some patches see one, and most of these are
/// foretold better by the surface of one side than by a smooth one. On solids with edges that is so
/// for 55 to 95 %. Where a surface bends more than its segments' surfaces can follow, or noise
/// hides the sides, points see edges as well, but a smooth surface of the nearest is as good or
/// better.
bool seesEdges(const RecomputationScene& scene, const Looks& looks,
               const std::vector<Proposal>& proposals) {
  std::size_t all = 0;
  std::size_t sharp = 0;
  std::size_t nearer = 0;
  for (const std::size_t p : looks.sample) {
    for (std::size_t r = looks.patches[p].begin; r < looks.patches[p].end; ++r) {
      ++all;
      const Recomputed& result = proposals[r].result;
      if (!result.accepted) continue;
      ++sharp;
      nearer += proposals[r].off < offSmoothSurface(scene, result.point) ? 1 : 0;
    }
  }
  const auto most = [](std::size_t some, std::size_t of) {
    return static_cast<double>(some) >= kAgreement * static_cast<double>(of);
  };
  return sharp > 0 && most(sharp, all) && most(nearer, sharp);
}

/// Whether the points include the edges themselves.
bool includeEdges(const std::vector<Proposal>& proposals) {
  std::size_t on = 0;
  std::size_t near = 0;
  for (const Proposal& p : proposals) {
    if (!p.result.accepted) continue;
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
    results.back().on_edge = edged && on_edges && p.to_other_face < kHalfRow;
    if (results.back().on_edge) results.back().accepted = false;
    if (!results.back().accepted) continue;
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

}  // namespace

struct OneSidedRule::Rounds {
  Round last;
};

OneSidedRule::OneSidedRule(const RecomputationOptions& options, OneSidedNormal which)
    : options_(options), which_(which), rounds_(std::make_unique<Rounds>()) {}
OneSidedRule::~OneSidedRule() = default;

std::vector<Recomputed> OneSidedRule::apply(const RecomputationScene& scene) {
  std::vector<std::uint8_t> state(scene.size());
  Round now;
  now.looks = layPatches(scene, state);
  Proposer proposer(scene, options_, which_, rounds_->last, now);
  const Looks& looks = now.looks;
  proposer.run(looks.sample.size(), [&](std::size_t p) { return looks.sample[p]; });
  const bool edged = seesEdges(scene, looks, now.proposals);
  if (edged) proposer.run(looks.patches.size(), [](std::size_t p) { return p; });
  std::vector<Recomputed> results = elect(scene, edged, now.proposals, state);
  now.labels = scene.labels;
  rounds_->last = std::move(now);
  return results;
}

}  // namespace segorient::detail
