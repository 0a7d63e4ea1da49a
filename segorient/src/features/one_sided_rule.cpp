// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "common/parallel_for.h"
#include "features/one_sided_looks.h"
#include "features/one_sided_view.h"
#include "features/recompute_scene.h"

namespace segorient::detail {
namespace {

// Share of the points around, of the points along the same border, and of all points looked at,
// that must see the edge as well: an edge is a line of points, and one that stands alone is noise
// or curvature.
constexpr double kAgreement = 0.5;
// Neighbours of the smallest surfaces that estimates without noise are made of.
constexpr int kSmoothNeighbors = 10;
// Distances to the other face, in spacings, that tell whether points lie on the edges themselves:
// of points anywhere on two faces a twentieth of those within one spacing are within .05. Four
// times as many are no chance, but vertices of a mesh, a third of which are the row on the edge.
constexpr double kOnEdge = 0.05;
constexpr double kNearEdge = 1.0;
constexpr double kManyOnEdge = 0.2;
// Half a row of vertices: what is nearer belongs to the row on the edge.
constexpr double kHalfRow = 0.5;

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
    parallelFor(
        count, scene_.threads, 20000.0, [&] { return OneSidedView(scene_, options_, which_); },
        [&](std::size_t p, OneSidedView& view) {
          const std::size_t at = patchAt(p);
          if (now_.known[at] == 0 && !takeOver(at)) propose(now_.looks.patches[at], view);
          now_.known[at] = 1;
        });
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

bool neighborsAgree(const RecomputationScene& scene, const std::vector<LookState>& state,
                    std::size_t i) {
  int examined = 0;
  int sharp = 0;
  for (int j = 0; j < scene.count(i); ++j) {
    const LookState s = state[scene.neighbor(i, j)];
    examined += s != LookState::UNTOUCHED ? 1 : 0;
    sharp += s == LookState::SHARP ? 1 : 0;
  }
  return sharp >= kAgreement * examined;
}

/// What along each border saw it as sharp.
struct Votes {
  std::size_t all = 0;
  std::size_t sharp = 0;
};

/// Accepts what the points around and along the same border agree with.
std::vector<Recomputed> elect(const RecomputationScene& scene, bool edged, bool on_edges,
                              const std::vector<Proposal>& proposals,
                              std::vector<LookState>& state) {
  std::map<std::pair<std::int32_t, std::int32_t>, Votes> votes;
  for (const Proposal& p : proposals) {
    if (p.result.accepted) state[p.result.point] = LookState::SHARP;
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

OneSidedRule::OneSidedRule(const RecomputationOptions& options, OneSidedNormal which,
                           std::optional<KnownEdges> known)
    : options_(options), which_(which), known_(known), rounds_(std::make_unique<Rounds>()) {}
OneSidedRule::~OneSidedRule() = default;

std::vector<Recomputed> OneSidedRule::apply(const RecomputationScene& scene) {
  std::vector<LookState> state(scene.size());
  Round now;
  now.looks = layPatches(scene, state);
  Proposer proposer(scene, options_, which_, rounds_->last, now);
  const Looks& looks = now.looks;
  proposer.run(looks.sample.size(), [&](std::size_t p) { return looks.sample[p]; });
  const bool edged = known_ ? known_->any : seesEdges(scene, looks, now.proposals);
  if (edged) proposer.run(looks.patches.size(), [](std::size_t p) { return p; });
  const bool on_edges = known_ ? known_->with_points : includeEdges(now.proposals);
  std::vector<Recomputed> results = elect(scene, edged, on_edges, now.proposals, state);
  now.labels = scene.labels;
  rounds_->last = std::move(now);
  return results;
}

}  // namespace segorient::detail
