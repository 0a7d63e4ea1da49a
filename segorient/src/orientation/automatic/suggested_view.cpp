// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/suggested_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/at.h"
#include "common/box.h"
#include "common/dot.h"
#include "common/every_nth.h"
#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/height_field.h"
#include "orientation/sensors/seen_from.h"

namespace segorient::detail {
namespace {

// Cosines of the half angle of a cone with nearly all points: three or four images side by side are
// 110 degrees wide, what is less than 20 is hardly an image of the whole.
constexpr float kWidestCone = 0.574F;
constexpr float kNarrowestCone = 0.985F;
constexpr std::size_t kBeyond = 20;  // one point of so many may be outside of it
// Cameras keep a distance. Of the nearest points over that of the median one: 200 images, single,
// cut, and two to four fused ones, .30 and more. From a corner of a body's box it is .17 at most.
constexpr float kNearestShare = 0.25F;
// Points that the extent is taken from, and the share of them at each end that may be strays.
constexpr std::size_t kSample = 20000;
constexpr std::size_t kStrays = 100;
// Mean cosine between normals and the way to the place: 0 of what is closed, 1/2 of surfaces that
// face the place and are turned at random.
constexpr float kFaces = 0.2F;

float quantile(std::vector<float>& values, std::size_t one_of) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / one_of);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Whether what is seen from a place may be an image.
bool isBefore(const PointView& points, const std::array<float, 3>& place) {
  std::vector<float> sample;
  for (const std::size_t i : EveryNth(points.size, kSample)) {
    sample.insert(sample.end(), points[i], points[i] + 3);
  }
  SeenFrom seen = seeFrom(place, {sample.data(), 3, sample.size() / 3}, 1);
  std::array<float, 3> axis{};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) axis[a] += seen.direction[4 * i + a];
  }
  const float length = std::sqrt(dot(axis.data(), axis.data()));
  if (!(length > 0.F) || !std::isfinite(length)) return false;
  std::vector<float> cosines;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    cosines.push_back(dot(&seen.direction[4 * i], axis.data()) / length);
  }
  const float width = quantile(cosines, kBeyond);
  return width > kWidestCone && width < kNarrowestCone &&
         quantile(seen.distance, kStrays) > kNearestShare * quantile(seen.distance, 2);
}

// Land is wider than high.
bool isUnder(const Box& cloud, const std::array<float, 3>& place) {
  const float width = std::hypot(cloud.high[0] - cloud.low[0], cloud.high[1] - cloud.low[1]);
  return looksUpAt(place, cloud.center()) && place[2] < cloud.low[2] &&
         cloud.high[2] - cloud.low[2] > kMostRelief * width;
}

// How far each cluster faces the place.
std::vector<Ballot> facingPlace(const SheetSigns& sheets, const std::array<float, 3>& place) {
  std::vector<Ballot> out(sheets.clusters.size());
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    const std::int32_t s = sheets.segmentation.labels[i];
    if (s < 0) continue;
    std::array<float, 3> way{};
    for (std::size_t a = 0; a < 3; ++a) way[a] = place[a] - sheets.points[i][a];
    const float along = dot(sheets.field.normals + 4 * i, way.data());
    const float cosine = along / std::sqrt(dot(way.data(), way.data()));
    if (std::isfinite(cosine)) out[at(sheets.clusters.of(at(s)))].add(sheets.pointSign(i) * cosine);
  }
  return out;
}

// Of each component, with its segments' signs so far.
std::vector<float> meanCosines(const SheetSigns& sheets, const std::vector<Ballot>& facing,
                               const std::vector<std::int32_t>& component_of) {
  std::vector<float> out(sheets.windings.size(), 0.F);
  for (std::size_t c = 0; c < facing.size(); ++c) {
    if (component_of[c] >= 0) out[at(component_of[c])] += static_cast<float>(facing[c].balance);
  }
  const std::vector<std::size_t> counts = sheets.componentSizes();
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] /= static_cast<float>(std::max<std::size_t>(1, counts[c]));
  }
  return out;
}

// Clusters of components that face the place, unless their borders know better.
// \param sides of each component: what turns it to the place, 0 = it is not asked
void turnClusters(const std::vector<std::int8_t>& sides,
                  const std::vector<std::int32_t>& component_of, std::vector<Ballot> facing,
                  SheetSigns& sheets) {
  for (std::size_t c = 0; c < facing.size(); ++c) {
    const int side = component_of[c] < 0 ? 0 : sides[at(component_of[c])];
    facing[c].balance *= side;
  }
  sheets.turnClusters(sheets.outvoted(facing, kSureBorders));
}

}  // namespace

std::vector<bool> faceSuggestedPlace(SheetSigns& sheets,
                                     std::vector<ComponentOrientationResult>& components) {
  std::vector<bool> out(components.size(), false);
  const std::array<float, 3>& place = sheets.hints.suggested;
  const bool asked = sheets.hints.place.may_be_suggested && sheets.points.size > 0 &&
                     sheets.hints.surface != SurfaceKind::CLOSED;
  const bool suits = sheets.hints.place.suggestion_suits;
  if (!asked || !(suits || isBefore(sheets.points, place))) return out;
  const bool under = suits || isUnder(boxWithout(kStrays, sheets.points, kSample), place);
  const std::vector<Ballot> facing = facingPlace(sheets, place);
  const std::vector<std::int32_t> component_of = sheets.componentsOfClusters();
  const std::vector<float> cosines = meanCosines(sheets, facing, component_of);
  std::vector<std::int8_t> sides(components.size(), 0);
  for (std::size_t c = 0; c < components.size(); ++c) {
    ComponentOrientationResult& component = components[c];
    const bool closed = !suits && sheets.looksClosed(c, kOpenResidual);
    if (component.by == DecidedBy::HINTS || closed || (sheets.ground[c] && !under)) continue;
    if (std::fabs(cosines[c]) < kFaces) continue;
    out[c] = true;
    sides[c] = cosines[c] < 0.F ? std::int8_t{-1} : std::int8_t{1};
    if (sides[c] == component.sign) continue;
    component.sign = sides[c];
    component.by = DecidedBy::NOTHING;
    component.confidence = 0.F;
  }
  turnClusters(sides, component_of, facing, sheets);
  return out;
}

}  // namespace segorient::detail
