// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/room_shadows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/at.h"
#include "common/box.h"
#include "common/dot.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/depth_steps.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

using Place = std::array<float, 3>;

// Places in the cloud's box, and of these the deepest within, which are looked from.
constexpr int kPlaces = 128;
constexpr std::size_t kDeepest = 16;
// Directions, squares on the sides of a cube, and points that say whether a place is within: ten
// for each, so that none is empty by chance.
constexpr std::size_t kSquares = 5;
constexpr std::size_t kSeen = 1500;
// Spacings to the nearest point: closer to a surface it is seen between its points.
constexpr float kClearance = 3.F;
// Of all directions: what is more open is no room.
constexpr float kMostOpen = 0.1F;
// Of all points, those on surfaces: noise takes points off them, so that what is covered does not
// show to be. Rooms .51 and more, a body with a cavity in noise of half a spacing .13.
constexpr double kFewOnSurfaces = 0.25;
// Points on surfaces, for each place.
constexpr std::size_t kSamples = 600;
// Of the deepest places so many have to be enclosed, and half of those that were tried.
constexpr std::size_t kFewest = 3;
// After so many places convex bodies show that they are no rooms, after twice as many most others.
constexpr std::size_t kFirst = 4;
// Of points on surfaces: those beside a step, the median of places; less are errors.
constexpr float kFewBeside = 0.005F;
// Of steps that no noise hides, those with surfaces all around, the median of places. In a room
// fewer far points are covered, and fewer of what stands before something have it all around behind
// them. A small body covers less than there is beside it, and what one scanner did not see another
// did; the mean of both is .62 at most of 152 rooms, most of them thinned by 2 to 3.5 spacings, .74
// and more of 207 clouds of bodies and sheets that may be looked from within, clean and in noise,
// and, but for four whose cavities are five spacings wide, .68 and more of 43 boxes with others in
// them.
constexpr float kMostCovered = 0.65F;
// Of the borders between segments, those that the result contradicts: of 58 rooms, thinned and in
// noise, .05 and more, but for one of .04, as shadows take surfaces apart. Of 15 bodies that were
// taken for rooms, whole ones with bumps, letters or teeth that hide little from within, and seen
// by cameras around them, .04 at most.
constexpr float kFewContradict = 0.045F;
// Points on surfaces, for each place: few of them stand before something.
constexpr std::size_t kSamplesBehind = 2400;

// The box without the hundredth at each end, where strays are.
std::vector<Place> placesInBox(const FlatPoints& flat) {
  // Fractions that fill a cube evenly: powers of the inverse of the root of x^4 = x + 1.
  constexpr double kRoot = 1.2207440846057596;
  const Box box = boxWithout(100, flat.view(), flat.size());
  std::vector<Place> out;
  for (int k = 1; k <= kPlaces; ++k) {
    Place place{};
    double step = 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
      step /= kRoot;
      const auto part = static_cast<float>(std::fmod(0.5 + k * step, 1.0));
      place[a] = box.low[a] + part * (box.high[a] - box.low[a]);
    }
    out.push_back(place);
  }
  return out;
}

// Whether there are points in half of all directions: beside a room that does not lie along the
// axes its box has places that are deeper than any in it.
bool hasPointsAround(const FlatPoints& flat, const Place& place) {
  std::array<bool, 6 * kSquares * kSquares> seen{};
  for (const std::size_t i : EveryNth(flat.size(), kSeen)) {
    const float* p = flat.view()[i];
    const Place way{p[0] - place[0], p[1] - place[1], p[2] - place[2]};
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (std::fabs(way[a]) > std::fabs(way[axis])) axis = a;
    }
    if (!(std::fabs(way[axis]) > 0.F)) continue;
    const auto square = [&](std::size_t a) {
      const float at = 0.5F + 0.5F * way[a % 3] / std::fabs(way[axis]);
      return std::min(kSquares - 1, static_cast<std::size_t>(at * static_cast<float>(kSquares)));
    };
    const std::size_t side = 2 * axis + (way[axis] < 0.F ? 1 : 0);
    seen[(side * kSquares + square(axis + 1)) * kSquares + square(axis + 2)] = true;
  }
  return 2 * std::count(seen.begin(), seen.end(), true) > static_cast<std::ptrdiff_t>(seen.size());
}

std::vector<Place> deepestPlaces(const FlatPoints& flat) {
  struct Deep {
    float clearance;
    Place place;
  };
  std::vector<Deep> deep;
  for (const Place& place : placesInBox(flat)) {
    if (!hasPointsAround(flat, place)) continue;
    const search::Nearest nearest(flat.index(), place.data());
    if (nearest.point < 0) continue;
    const float h = flat.spacing(static_cast<std::size_t>(nearest.point));
    const float distance = std::sqrt(nearest.square);
    if (h > 0.F && distance > kClearance * h) deep.push_back({distance / h, place});
  }
  std::stable_sort(deep.begin(), deep.end(),
                   [](const Deep& a, const Deep& b) { return a.clearance > b.clearance; });
  std::vector<Place> out;
  for (const Deep& d : deep) {
    if (out.size() == kDeepest) break;
    out.push_back(d.place);
  }
  return out;
}

// Of steps from which surfaces are on one side or all around, the latter: by the rule of
// succession, so that few say little.
float shareCovered(const std::vector<DepthSteps::Step>& found) {
  const auto count = [&](DepthSteps::Step step) {
    return static_cast<float>(std::count(found.begin(), found.end(), step) + 1);
  };
  const float covered = count(DepthSteps::Step::COVERED);
  return covered / (covered + count(DepthSteps::Step::BESIDE));
}

// What is seen of some points on surfaces, from all places together.
class Room {
 public:
  Room(const FlatPoints& flat, int threads)
      : flat_(flat),
        threads_(threads),
        rows_(flat.someOnSurfaces(kSamples)),
        toward_(3 * rows_.size(), 0.F) {}

  // Whether the place is enclosed; if not, nothing is seen from there.
  bool lookFrom(const Place& place) {
    DepthSteps depth(flat_, place, threads_);
    if (depth.openShare() > kMostOpen) return false;
    const std::vector<DepthSteps::Step> found = depth.of(rows_, DepthSteps::Side::BEFORE, threads_);
    float beside = 0.F;
    for (std::size_t s = 0; s < rows_.size(); ++s) {
      const DepthSteps::Step step = found[s];
      if (step == DepthSteps::Step::BESIDE || step == DepthSteps::Step::HIDDEN) beside += 1.F;
      if (step == DepthSteps::Step::BESIDE || step == DepthSteps::Step::NONE) turnTo(place, s);
    }
    beside_.push_back(beside / static_cast<float>(rows_.size()));
    covered_.push_back(shareCovered(found));
    depths_.push_back(std::move(depth));
    return true;
  }

  std::size_t places() const { return beside_.size(); }
  float beside() const { return median(beside_); }
  float covered() const { return median(covered_); }
  // Of what is nearer than something beside it, that with surfaces all around behind it.
  float hasBehind() const {
    const std::vector<std::size_t> some = flat_.someOnSurfaces(kSamplesBehind);
    std::vector<float> shares;
    for (const DepthSteps& depth : depths_) {
      shares.push_back(shareCovered(depth.of(some, DepthSteps::Side::BEHIND, threads_)));
    }
    return median(shares);
  }
  std::size_t size() const { return rows_.size(); }
  std::size_t row(std::size_t s) const { return rows_[s]; }
  const float* toward(std::size_t s) const { return &toward_[3 * s]; }

 private:
  void turnTo(const Place& place, std::size_t s) {
    const float* p = flat_.view()[row(s)];
    const Place way{place[0] - p[0], place[1] - p[1], place[2] - p[2]};
    const float length = std::sqrt(dot(way.data(), way.data()));
    for (std::size_t a = 0; a < 3; ++a) {
      toward_[3 * s + a] += way[a] / (length * static_cast<float>(kDeepest));
    }
  }

  const FlatPoints& flat_;
  int threads_;
  std::vector<std::size_t> rows_;
  std::vector<float> toward_;   ///< 3 a sample
  std::vector<float> beside_;   ///< one a place: share of the samples
  std::vector<float> covered_;  ///< of the steps
  std::vector<DepthSteps> depths_;
};

// Of the nearest sample.
std::vector<float> ofPoints(const PointView& points, const FlatPoints& flat, const Room& room,
                            int threads) {
  std::vector<float> samples;
  for (std::size_t s = 0; s < room.size(); ++s) {
    const float* p = flat.view()[room.row(s)];
    samples.insert(samples.end(), p, p + 3);
  }
  const search::MedianHashIndex index = search::indexOf({samples.data(), 3, room.size()}, threads);
  std::vector<float> out(3 * points.size, 0.F);
  const std::vector<std::int32_t> nearest = search::nearestOf(index, points, threads);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (nearest[i] >= 0) std::copy_n(room.toward(at(nearest[i])), 3, &out[3 * i]);
  }
  return out;
}

}  // namespace

std::vector<float> directionsInARoom(const PointView& points, const FlatPoints& flat, int threads) {
  const auto on_surfaces = static_cast<double>(flat.onSurfaces().size());
  if (flat.size() == 0 || on_surfaces < kFewOnSurfaces * static_cast<double>(flat.size()))
    return {};
  Room room(flat, threads);
  std::size_t tried = 0;
  for (const Place& place : deepestPlaces(flat)) {
    ++tried;
    if (!room.lookFrom(place)) continue;
    if (room.places() == kFirst && !(room.beside() > 0.F)) return {};
    if (room.places() == 2 * kFirst && room.covered() >= kMostCovered) return {};
  }
  if (room.places() < std::max(kFewest, (tried + 1) / 2)) return {};
  if (room.beside() < kFewBeside || room.covered() >= kMostCovered) return {};
  if (0.5F * (room.covered() + room.hasBehind()) >= kMostCovered) return {};
  return ofPoints(points, flat, room, threads);
}

bool boundBodies(const std::vector<ComponentOrientationResult>& components) {
  double contradict = 0.0;
  double points = 0.0;
  for (const ComponentOrientationResult& c : components) {
    contradict += static_cast<double>(c.contradiction) * static_cast<double>(c.points);
    points += static_cast<double>(c.points);
  }
  return contradict < static_cast<double>(kFewContradict) * points;
}

}  // namespace segorient::detail
