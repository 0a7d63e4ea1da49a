// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/shadows.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/median.h"
#include "orientation/sensors/depth_steps.h"
#include "orientation/sensors/seen_from.h"

namespace segorient::detail {
namespace {

// Enough for shares of a hundredth.
constexpr std::size_t kSamples = 1500;

// Of points on surfaces, and how many of them at least: bodies seen whole from within have up to
// .04, where a limb begins.
constexpr float kFewSteps = 0.05F;
constexpr float kFewest = 15.F;
// Of these, with nearer ones all around. True places of 12 virtual and 15 real scans, as they were
// and thinned in seven ways, leave .00 to .17, among trees up to .40 and in noise of depth .46. In
// and around 30 closed bodies it is .46 and more (of one with clumps of outliers .415), nearly
// always above .5; in the middle of several stations .24 and more.
constexpr float kMostCovered = 0.2F;
constexpr float kAllowed = 0.41F;
constexpr float kDenied = 0.5F;
// Of some 280 stations and cameras that densities told of rightly, in whole, thinned and cut scans,
// .00 to .44; of six that they told of wrongly, but for one, .48 to .99.
constexpr float kContradicts = 0.46F;
// The same with points before them that noise has taken off all surfaces: true places .38 to .68 of
// the steps of thinned depth images, bodies in noise .9 and more.
constexpr float kMostHidden = 0.8F;
// Of directions: scanners that turn about an axis leave more, bodies around a place none.
constexpr float kOpen = 0.1F;
constexpr float kFewOpen = 0.005F;
constexpr float kMostOpen = 0.5F;
// Rooms that one scanner saw leave .05 of all directions open, below its tripod. Where others saw
// that, .02 and more of the points have something nearer beside them: of what furnishes the room.
constexpr float kHole = 0.02F;
constexpr float kFewBeside = 0.015F;
// All that is there lies within 60 degrees around one direction: no scanner is on its way there.
constexpr float kAbove = 0.75F;

using Place = std::array<float, 3>;

// Whether it is outside of the least ball around the middle that holds the points.
bool isOutside(const FlatPoints& flat, const Place& place, const Place& middle, int threads) {
  const SeenFrom seen = seeFrom(middle, flat.view(), threads);
  const SeenFrom it = seeFrom(middle, {place.data(), 3, 1}, 1);
  return it.distance[0] > *std::max_element(seen.distance.begin(), seen.distance.end());
}

// All but what is open.
void countSteps(const FlatPoints& flat, const DepthSteps& depth, int threads, Shadows& out) {
  const std::vector<DepthSteps::Step> found =
      depth.of(flat.someOnSurfaces(kSamples), DepthSteps::Side::BEFORE, threads);
  const auto count = [&](DepthSteps::Step what) {
    return static_cast<float>(std::count(found.begin(), found.end(), what));
  };
  const auto surface = static_cast<float>(found.size());
  const float covered = count(DepthSteps::Step::COVERED);
  const float hidden = covered + count(DepthSteps::Step::HIDDEN);
  const float steps = hidden + count(DepthSteps::Step::BESIDE);
  if (steps < kFewest) return;
  out.covered = covered / surface;
  out.hidden = hidden / surface;
  out.steps = steps / surface;
}

// \param least_open share of directions without which steps are not looked for
Shadows lookFrom(const FlatPoints& flat, const Place& place, float least_open, int threads) {
  const DepthSteps depth(flat, place, threads);
  Shadows out;
  out.open = depth.openShare();
  if (out.open >= least_open) countSteps(flat, depth, threads, out);
  return out;
}

}  // namespace

bool Shadows::confirm() const {
  return steps > kFewSteps && covered < kMostCovered * steps && hidden < kMostHidden * steps &&
         !better_across;
}

bool Shadows::reveal() const {
  return open > kOpen && confirm();
}

bool Shadows::inARoom() const {
  return open > kFewOpen && open < kMostOpen;
}

bool Shadows::enclose() const {
  return open <= kFewOpen && steps < kFewBeside;
}

bool Shadows::deny() const {
  return steps > kFewSteps && covered > kDenied * steps;
}

bool Shadows::contradict() const {
  return steps > 0.F && covered > kContradicts * steps;
}

bool Shadows::hideNothing(bool has_walls) const {
  return open < kHole && !has_walls && steps < kFewBeside;
}

bool Shadows::asOfABody(bool has_walls, bool is_one_of_several) const {
  const bool enclosed = open < kHole;
  // Others saw what is hidden from one: .46 to .66 in a room, in the middle of three, and up to .77
  // where they stood in several rooms.
  const bool is_alone = !is_one_of_several;
  return hideNothing(has_walls) || covered > (enclosed && is_alone ? kDenied : kMostHidden) * steps;
}

bool Shadows::allow() const {
  return steps > kFewSteps && covered < kAllowed * steps && hidden < kMostHidden * steps;
}

bool Shadows::suit() const {
  return open > kMostOpen && steps > kFewSteps && !contradict() && hidden < kMostHidden * steps;
}

bool Shadows::excuse() const {
  return open > kOpen && steps > 0.F && covered < kAllowed * steps && hidden < kMostHidden * steps;
}

bool areAtOneBody(const std::vector<Shadows>& places, bool has_walls, bool on_its_way) {
  const bool are_several = places.size() > 1;
  if (std::all_of(places.begin(), places.end(),
                  [&](const Shadows& s) { return s.asOfABody(has_walls, are_several); })) {
    return true;
  }
  std::vector<float> open;
  std::vector<float> steps;
  for (const Shadows& s : places) {
    open.push_back(s.open);
    steps.push_back(s.steps);
  }
  if (median(steps) >= kFewBeside) return false;
  if (on_its_way) return !has_walls || median(open) > kAbove;
  return !has_walls && median(open) < kHole;
}

Shadows findShadows(const FlatPoints& flat, const Place& place, int threads, bool to_reveal) {
  if (flat.size() == 0) return {};
  const float least_open = to_reveal ? kOpen : 0.F;
  Shadows out = lookFrom(flat, place, least_open, threads);
  if (!out.confirm()) return out;
  const Place middle = flat.middle();
  if (!isOutside(flat, place, middle, threads)) return out;
  Place across;
  for (std::size_t a = 0; a < 3; ++a) across[a] = 2.F * middle[a] - place[a];
  const Shadows other = lookFrom(flat, across, least_open, threads);
  out.better_across = other.confirm() && other.coveredOfSteps() <= out.coveredOfSteps();
  return out;
}

Shadows findShadows(const PointView& points, const Place& place, int threads) {
  if (points.size == 0) return {};
  return findShadows(FlatPoints(points, threads), place, threads);
}

}  // namespace segorient::detail
