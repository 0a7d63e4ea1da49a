// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/suggested_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/at.h"
#include "common/dot.h"
#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/height_field.h"

namespace segorient::detail {
namespace {

// Radii of the cloud, whose image is 20 degrees wide from there.
constexpr float kFarthest = 5.8F;
// Points that the extent is taken from, and the share of them at each end that may be strays.
constexpr std::size_t kSample = 20000;
constexpr std::size_t kStrays = 100;
// A third of the votes more for one side than for the other: two of three.
constexpr float kMost = 1.F / 3.F;

// A ball has half of its box's diagonal as its radius at most.
bool isBefore(const Box& cloud, const std::array<float, 3>& place) {
  const std::array<float, 3> middle = cloud.center();
  std::array<float, 3> way{};
  for (std::size_t a = 0; a < 3; ++a) way[a] = place[a] - middle[a];
  const float distance = std::sqrt(dot(way.data(), way.data()));
  const float radius = 0.5F * cloud.diagonal();
  return distance > radius && distance < kFarthest * radius;
}

// Land is wider than high.
bool isUnder(const Box& cloud, const std::array<float, 3>& place) {
  const float width = std::hypot(cloud.high[0] - cloud.low[0], cloud.high[1] - cloud.low[1]);
  return looksUpAt(place, cloud.center()) && place[2] < cloud.low[2] &&
         cloud.high[2] - cloud.low[2] > kMostRelief * width;
}

// How far each cluster faces the place.
std::vector<Ballot> facingOf(const SheetSigns& sheets, const std::array<float, 3>& place) {
  std::vector<Ballot> out(sheets.clusters.size());
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    const std::int32_t s = sheets.segmentation.labels[i];
    if (s < 0) continue;
    std::array<float, 3> way{};
    for (std::size_t a = 0; a < 3; ++a) way[a] = place[a] - sheets.points[i][a];
    const float along = dot(sheets.field.normals + 4 * i, way.data());
    const float cosine = along / std::sqrt(dot(way.data(), way.data()));
    if (!std::isfinite(cosine)) continue;
    Ballot& ballot = out[at(sheets.clusters.of(at(s)))];
    ballot.balance += sheets.pointSign(i) * cosine;
    ballot.total += std::fabs(cosine);
  }
  return out;
}

// The component of each cluster, -1 for names of none.
std::vector<std::int32_t> componentsOf(const SheetSigns& sheets) {
  std::vector<std::int32_t> out(sheets.clusters.size(), -1);
  for (std::size_t s = 0; s < out.size(); ++s) {
    out[at(sheets.clusters.of(s))] = sheets.component_of[s];
  }
  return out;
}

}  // namespace

void faceSuggestedPlace(SheetSigns& sheets, std::vector<ComponentOrientationResult>& components) {
  const std::array<float, 3>& place = sheets.hints.suggested;
  if (!sheets.hints.place.may_be_suggested || sheets.points.size == 0) return;
  const Box cloud = boxWithout(kStrays, sheets.points, kSample);
  if (!isBefore(cloud, place)) return;
  const bool under = isUnder(cloud, place);
  std::vector<Ballot> facing = facingOf(sheets, place);
  const std::vector<std::int32_t> component_of = componentsOf(sheets);
  std::vector<Ballot> sums(components.size());
  for (std::size_t c = 0; c < facing.size(); ++c) {
    if (component_of[c] >= 0) sums[at(component_of[c])].add(facing[c], 1);
  }
  std::vector<int> turn(components.size(), 0);
  for (std::size_t c = 0; c < components.size(); ++c) {
    ComponentOrientationResult& component = components[c];
    const bool land = sheets.ground[c] && !under;
    const bool known =
        component.by == DecidedBy::HINTS || sheets.hints.surface == SurfaceKind::CLOSED;
    if (known || land || sheets.windings[c].residual <= kOpenResidual) continue;
    const float share = sums[c].share();
    if (std::fabs(share) < kMost) continue;
    turn[c] = share < 0.F ? -1 : 1;
    if (turn[c] == component.sign) continue;
    component.sign = static_cast<std::int8_t>(turn[c]);
    component.by = DecidedBy::NOTHING;
    component.confidence = 0.F;
  }
  for (std::size_t c = 0; c < facing.size(); ++c) {
    const int sign = component_of[c] < 0 ? 0 : turn[at(component_of[c])];
    facing[c] = {static_cast<float>(sign) * facing[c].balance, facing[c].total};
  }
  sheets.turnClusters(sheets.outvoted(facing, kSureBorders));
}

}  // namespace segorient::detail
