// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/room_shadows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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

// Places in the cloud's box, and of these the deepest, which are looked from.
constexpr int kPlaces = 128;
constexpr std::size_t kDeepest = 16;
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
// Of steps that no noise hides, those with nearer surfaces all around, by the rule of succession, the
// median of places: of 152 rooms, most of them thinned by 2 to 3.5 spacings, .55 at most; of 207
// clouds of bodies and sheets that may be looked from within, clean and in noise, .75 and more.
constexpr float kMostCovered = 0.65F;

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

std::vector<Place> deepestPlaces(const FlatPoints& flat) {
  struct Deep {
    float clearance;
    Place place;
  };
  std::vector<Deep> deep;
  for (const Place& place : placesInBox(flat)) {
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

// What is seen of some points on surfaces, from all places together.
class Room {
 public:
  Room(const FlatPoints& flat, int threads)
      : flat_(flat),
        threads_(threads),
        rows_(flat.onSurfaces().size(), kSamples),
        toward_(3 * rows_.size(), 0.F) {}

  // Whether the place is enclosed; if not, nothing is seen from there.
  bool lookFrom(const Place& place) {
    const DepthSteps depth(flat_, place, threads_);
    if (depth.openShare() > kMostOpen) return false;
    const std::vector<DepthSteps::Step> found = depth.of(rows_, threads_);
    float covered = 0.F;
    float hidden = 0.F;
    float beside = 0.F;
    for (std::size_t s = 0; s < rows_.size(); ++s) {
      switch (found[s]) {
        case DepthSteps::Step::COVERED:
          covered += 1.F;
          break;
        case DepthSteps::Step::HIDDEN:
          hidden += 1.F;
          break;
        case DepthSteps::Step::BESIDE:
          beside += 1.F;
          [[fallthrough]];
        case DepthSteps::Step::NONE:
          turnTo(place, s);
      }
    }
    beside_.push_back((hidden + beside) / static_cast<float>(rows_.size()));
    covered_.push_back((covered + 1.F) / (covered + beside + 2.F));
    return true;
  }

  std::size_t places() const { return beside_.size(); }
  float beside() const { return median(beside_); }
  float covered() const { return median(covered_); }
  std::size_t size() const { return rows_.size(); }
  std::size_t row(std::size_t s) const { return flat_.onSurfaces()[rows_[s]]; }
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
  EveryNth rows_;
  std::vector<float> toward_;   ///< 3 a sample
  std::vector<float> beside_;   ///< one a place: share of the samples
  std::vector<float> covered_;  ///< of the steps
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
  return ofPoints(points, flat, room, threads);
}

}  // namespace segorient::detail
