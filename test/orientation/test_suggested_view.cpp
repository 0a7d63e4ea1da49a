// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Evenly sampled surfaces that tell of no sensor, and a place where one may have stood.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <vector>

#include "orientation/sensors/shadows.h"
#include "sensor_scans.h"
#include "voxel_thinned.h"

namespace segorient {
namespace {

using Floats = std::array<float, 3>;

// A wall that bends a little, and hides nothing.
std::vector<float> wallAt(const Floats& middle, std::size_t count) {
  std::mt19937 random(21);
  std::uniform_real_distribution<float> unit(-1.F, 1.F);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    const float u = unit(random);
    const float v = unit(random);
    const float w = 0.4F * u * u + 0.2F * v * v + 0.1F * std::sin(5.F * u);
    rows.insert(rows.end(), {middle[0] + u, middle[1] - w, middle[2] + v});
  }
  return rows;
}

// How many normals point along a direction. \param direction of each point
template <typename Direction>
std::size_t countAlong(const OrientedCloud& cloud, const Direction& direction) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.normals.size() / 4; ++i) {
    const Floats along = direction(i);
    float sum = 0.F;
    for (std::size_t a = 0; a < 3; ++a) sum += cloud.normals[4 * i + a] * along[a];
    count += sum > 0.F ? 1 : 0;
  }
  return count;
}

// Share of normals that point along a direction.
double shareAlong(const std::vector<float>& rows, const Floats& direction,
                  const std::shared_ptr<OrientationHints>& hints = nullptr) {
  PipelineOptions options;
  options.orientation.hints = hints;
  const std::size_t n = rows.size() / 3;
  const OrientedCloud cloud = orientCloud({rows.data(), 3, n}, nullptr, options);
  EXPECT_TRUE(cloud.report.sensors.sensors.empty()) << cloud.report.sensors.why;
  const std::size_t count = countAlong(cloud, [&](std::size_t) { return direction; });
  return static_cast<double>(count) / static_cast<double>(n);
}

TEST(SuggestedView, WhatIsOpenFacesIt) {
  // From both sides of the sheet.
  EXPECT_EQ(shareAlong(wallAt({0.2F, 3.F, 0.1F}, 9000), {0.F, -1.F, 0.F}), 1.0);
  EXPECT_EQ(shareAlong(wallAt({0.2F, -3.F, 0.1F}, 9000), {0.F, 1.F, 0.F}), 1.0);
  // Another place than the origin.
  const auto hints = std::make_shared<OrientationHints>();
  hints->suggested = {{10.F, 23.F, 0.F}};
  EXPECT_EQ(shareAlong(wallAt({10.F, 20.F, 0.F}, 9000), {0.F, 1.F, 0.F}, hints), 1.0);
}

TEST(SuggestedView, NobodySeesFromTooFarOrWithin) {
  const double far = shareAlong(wallAt({1.F, 12.F, 1.F}, 9000), {0.F, -1.F, 0.F});
  EXPECT_EQ(shareAlong(wallAt({1.F, -12.F, 1.F}, 9000), {0.F, -1.F, 0.F}), far);
  const double within = shareAlong(wallAt({0.F, 0.1F, 0.F}, 9000), {0.F, -1.F, 0.F});
  EXPECT_EQ(shareAlong(wallAt({0.F, 0.9F, 0.F}, 9000), {0.F, -1.F, 0.F}), within);
  const auto hints = std::make_shared<OrientationHints>();
  hints->suggested = {{std::nanf(""), 3.F, 0.F}};
  EXPECT_EQ(shareAlong(wallAt({1.F, 12.F, 1.F}, 9000), {0.F, -1.F, 0.F}, hints), far);
}

// A wall behind another one was not seen from there.
TEST(SuggestedView, NobodySeesThroughWalls) {
  const auto wallsAt = [](float y) {
    std::vector<float> rows = wallAt({0.2F, y, 0.1F}, 5000);
    const std::vector<float> other = wallAt({0.2F, y + 1.F, 0.1F}, 5000);
    rows.insert(rows.end(), other.begin(), other.end());
    return rows;
  };
  const Floats before{0.F, -1.F, 0.F};
  EXPECT_EQ(shareAlong(wallsAt(3.F), before), shareAlong(wallsAt(-4.F), before));
}

TEST(SuggestedView, ASideThatIsNamedGoesBefore) {
  const std::vector<float> rows = wallAt({0.F, 3.F, 0.F}, 9000);
  const auto hints = std::make_shared<OrientationHints>();
  hints->seeds.push_back({{0.F, 3.F, 0.F}, {0.F, 1.F, 0.F}});
  EXPECT_EQ(shareAlong(rows, {0.F, 1.F, 0.F}, hints), 1.0);
}

// Half of a ball faces the place, but the other one is there as well.
TEST(SuggestedView, WhatIsClosedKeepsItsSide) {
  std::mt19937 random(22);
  std::normal_distribution<float> gauss;
  std::vector<float> rows;
  std::vector<Floats> out;
  for (int i = 0; i < 6000; ++i) {
    Floats d{};
    float square = 0.F;
    for (float& v : d) {
      v = gauss(random);
      square += v * v;
    }
    for (float& v : d) v /= std::sqrt(square);
    out.push_back(d);
    rows.insert(rows.end(), {d[0], d[1] + 3.F, d[2]});
  }
  const OrientedCloud cloud = orientCloud({rows.data(), 3, rows.size() / 3}, nullptr, {});
  EXPECT_EQ(countAlong(cloud, [&](std::size_t i) { return out[i]; }), rows.size() / 3);
}

// Height over the sea is no distance to a camera, of what is wider than high.
TEST(SuggestedView, LandFacesUp) {
  std::mt19937 random(23);
  std::uniform_real_distribution<float> unit(-1.F, 1.F);
  std::vector<float> rows;
  for (int i = 0; i < 9000; ++i) {
    const float x = unit(random);
    const float y = unit(random);
    rows.insert(rows.end(), {x, y, 3.F + 0.2F * std::sin(2.F * x) * std::cos(3.F * y)});
  }
  EXPECT_EQ(shareAlong(rows, {0.F, 0.F, 1.F}), 1.0);
}

// Part of a room as some places around the origin have seen it together, thinned: what hides
// something hides less of it from all of them, and the room is not enclosed.
TEST(SuggestedView, ShadowsThatSuitItTellOfSomePlaces) {
  Room room;
  room.low = {2.6, 1.4, 0.0};
  room.high = {3.4, 2.2, 1.1};
  const Vector first{1.2, 1.1, 1.5};
  std::vector<float> seen;
  for (const Vector& place : {first, Vector{1.5, 2.3, 1.2}, Vector{1.6, 0.4, 2.0}}) {
    const std::vector<float> rows = scanFrom(place, 1.0, room).rows();
    for (std::size_t i = 0; i < rows.size(); i += 3) {
      if (!(rows[i] > 1.7F && rows[i + 2] < 2.2F)) continue;  // no wall behind them, no ceiling
      Floats p{};
      for (std::size_t a = 0; a < 3; ++a) p[a] = rows[i + a] - static_cast<float>(first[a]);
      // As cameras have it: to the right, down, ahead.
      seen.insert(seen.end(), {-p[1], -p[2], p[0]});
    }
  }
  const std::vector<float> thin = test::thinned({seen.data(), 3, seen.size() / 3}, 0.08);
  const PointView points{thin.data(), 4, thin.size() / 4};
  const detail::Shadows shadows = detail::findShadows(points, {0.F, 0.F, 0.F}, 0);
  EXPECT_FALSE(shadows.reveal());
  EXPECT_TRUE(shadows.suit()) << shadows.open << " " << shadows.steps << " " << shadows.covered;
  const OrientedCloud cloud = orientCloud(points, nullptr, {});
  const std::size_t facing = countAlong(cloud, [&](std::size_t i) {
    return Floats{-points[i][0], -points[i][1], -points[i][2]};
  });
  EXPECT_GT(static_cast<double>(facing), 0.95 * static_cast<double>(points.size))
      << cloud.report.components[0].residual;
}

}  // namespace
}  // namespace segorient
