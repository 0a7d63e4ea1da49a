// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/one_sided_looks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "common/every_nth.h"
#include "common/parallel_for.h"
#include "common/sort_all.h"

namespace segorient::detail {
namespace {

// Normals that differ by less than this (11 degrees) around a point need no second look.
const double kFlat = std::cos(0.2);
// A point shares the patch of one of this many nearest: within that distance patches differ little.
constexpr int kPatchNeighbors = 12;
// Patches that shares of all points are measured on: they are then known to a few hundredths.
constexpr std::size_t kSampledPatches = 512;
std::vector<std::size_t> pointsAtBorders(const RecomputationScene& scene,
                                         std::vector<LookState>& state) {
  parallelFor(scene.size(), scene.threads, 20.0, [&](std::size_t i) {
    state[i] = scene.meetsBorder(i, kFlat) ? LookState::EXAMINED : LookState::UNTOUCHED;
  });
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (state[i] == LookState::EXAMINED) points.push_back(i);
  }
  return points;
}

/// By coordinates, so that nothing depends on the order of the points.
std::vector<std::size_t> inOrderOfPlace(const RecomputationScene& scene,
                                        const std::vector<std::size_t>& points) {
  std::vector<std::pair<std::array<float, 3>, std::size_t>> places(points.size());
  parallelFor(points.size(), scene.threads, 10.0, [&](std::size_t at) {
    const float* p = scene.points[points[at]];
    places[at] = {{p[0], p[1], p[2]}, points[at]};
  });
  sortAll(places, scene.threads, std::less<>());
  std::vector<std::size_t> out;
  out.reserve(places.size());
  for (const auto& [place, i] : places) out.push_back(i);
  return out;
}

}  // namespace

Looks layPatches(const RecomputationScene& scene, std::vector<LookState>& state) {
  const auto middleNear = [&](std::size_t i) {
    const int count = std::min(scene.count(i), kPatchNeighbors + 1);
    for (int j = 0; j < count; ++j) {
      if (state[scene.neighbor(i, j)] == LookState::MIDDLE) return scene.neighbor(i, j);
    }
    return scene.size();
  };
  const std::vector<std::size_t> examined = pointsAtBorders(scene, state);
  std::vector<std::size_t> middles;
  for (const std::size_t i : inOrderOfPlace(scene, examined)) {
    if (middleNear(i) < scene.size()) continue;
    state[i] = LookState::MIDDLE;
    middles.push_back(i);
  }
  std::vector<std::uint64_t> pairs(examined.size());  // middle above, point below
  parallelFor(examined.size(), scene.threads, 50.0, [&](std::size_t e) {
    pairs[e] = std::uint64_t{middleNear(examined[e])} << 32U | examined[e];
  });
  sortAll(pairs, scene.threads, std::less<>());

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
  for (const std::size_t m : EveryNth(middles.size(), kSampledPatches)) {
    const auto at = std::lower_bound(
        looks.patches.begin(), looks.patches.end(), middles[m],
        [](const Patch& patch, std::size_t middle) { return patch.middle < middle; });
    looks.sample.push_back(static_cast<std::size_t>(at - looks.patches.begin()));
  }
  return looks;
}

}  // namespace segorient::detail
