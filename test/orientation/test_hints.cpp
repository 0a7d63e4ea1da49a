// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What is known beforehand: how it is brought to the points, and what it changes.
#include <gtest/gtest.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/pipeline.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "orientation/sensors/point_hints.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

OrientedCloud orient(const std::vector<float>& xyz, const OrientationHints& hints) {
  PipelineOptions options;
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  return orientCloud(viewOf(xyz), nullptr, options);
}

OrientationHints seenFrom(float x, float y, float z) {
  OrientationHints hints;
  hints.has_viewpoint = true;
  hints.viewpoint = {x, y, z};
  return hints;
}

// Two unit squares, at z = 0 and z = 5.
std::vector<float> twoSquares(unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> xyz;
  for (int i = 0; i < 3000; ++i) {
    xyz.insert(xyz.end(), {unit(rng), unit(rng), i < 1500 ? 0.F : 5.F, 0.F});
  }
  return xyz;
}

// Share of the rows first..last-1 whose normal points up.
double up(const OrientedCloud& cloud, std::size_t first, std::size_t last) {
  std::size_t count = 0;
  for (std::size_t i = first; i < last; ++i) count += cloud.normals[4 * i + 2] > 0.F ? 1U : 0U;
  return static_cast<double>(count) / static_cast<double>(last - first);
}

TEST(ResolveHints, RowsOfThePointsThatAreLeft) {
  const std::vector<float> xyz{kNaN, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0};
  PreparedCloud cloud(viewOf(xyz), nullptr, 0);
  ASSERT_EQ(cloud.size(), 2U);
  OrientationHints hints;
  hints.normals = {1, 0, 0, 0, 0, 3, 0, 5, 0, 0, 0, kNaN};
  const PointHints points = resolveHints(hints, cloud);
  ASSERT_EQ(points.directions.size(), 6U);
  const auto second = static_cast<std::size_t>(cloud.pointOf(1));
  const auto third = static_cast<std::size_t>(cloud.pointOf(2));
  EXPECT_EQ(points.directions[3 * second + 2], 1.F) << "unit length; NaN of the repeated point no";
  EXPECT_EQ(points.directions[3 * third + 1], 1.F);
}

TEST(ResolveHints, IndicesChooseInputRows) {
  const std::vector<float> xyz{0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
  const std::vector<pcl::index_t> indices{2, 0};
  PreparedCloud cloud(viewOf(xyz), &indices, 0);
  OrientationHints hints;
  hints.viewpoints = {0, 0, 1, 1, 1, 0, 2, 4, 0};
  const PointHints points = resolveHints(hints, cloud);
  ASSERT_EQ(cloud.size(), 2U);
  const auto place = [&](std::size_t row, std::size_t axis) {
    return points.sensors[3 * static_cast<std::size_t>(cloud.pointOf(row)) + axis] * cloud.unit();
  };
  EXPECT_FLOAT_EQ(place(2, 1), 4.F);
  EXPECT_FLOAT_EQ(place(0, 2), 1.F);
}

TEST(ResolveHints, RowsWithoutAHintHaveNone) {
  const std::vector<float> xyz{0, 0, 0, 0, 1, 0, 0, 0};
  PreparedCloud cloud(viewOf(xyz), nullptr, 0);
  OrientationHints hints;
  hints.normals = {0, 0, 1};
  const PointHints points = resolveHints(hints, cloud);
  const auto last = static_cast<std::size_t>(cloud.pointOf(1));
  for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(points.directions[3 * last + a], 0.F);
}

TEST(ResolveHints, LengthsAreInTheCloudsUnit) {
  std::vector<float> xyz{0, 0, 0, 0, 1000, 0, 0, 0, 0, 1000, 0, 0};
  PreparedCloud cloud(viewOf(xyz), nullptr, 0);
  OrientationHints hints = seenFrom(0, 0, 5000);
  hints.seeds = {{{990.F, 3.F, 0.F}, {0.F, 0.F, -2.F}},
                 {{kNaN, 0.F, 0.F}, {1.F, 0.F, 0.F}},
                 {{0.F, 0.F, 0.F}, {0.F, 0.F, 0.F}}};
  const PointHints points = resolveHints(hints, cloud);
  EXPECT_TRUE(points.has_viewpoint);
  EXPECT_FLOAT_EQ(points.viewpoint[2] * cloud.unit(), 5000.F);
  ASSERT_EQ(points.seeds.size(), 1U) << "those that are no place, or no direction, are left out";
  EXPECT_EQ(points.seeds[0].point, static_cast<std::size_t>(cloud.pointOf(1)));
  EXPECT_EQ(points.seeds[0].normal[2], -1.F);
}

TEST(ResolveHints, ViewpointsFarAwayKeepTheirDirection) {
  const std::vector<float> xyz{0, 0, 0, 0, 1e-9F, 0, 0, 0};
  PreparedCloud cloud(viewOf(xyz), nullptr, 0);
  constexpr float kMost = std::numeric_limits<float>::max();
  const PointHints points = resolveHints(seenFrom(0.F, -kMost, kMost / 2), cloud);
  EXPECT_TRUE(points.has_viewpoint);
  EXPECT_FLOAT_EQ(points.viewpoint[1], -2.F * points.viewpoint[2]);
  EXPECT_TRUE(std::isfinite(points.viewpoint[1] * points.viewpoint[1]));
  EXPECT_FALSE(resolveHints(seenFrom(kNaN, 0.F, 0.F), cloud).has_viewpoint);
}

TEST(Hints, NormalsOfTheInputTurnEachPart) {
  const std::vector<float> xyz = twoSquares(61);
  OrientationHints hints;
  for (std::size_t i = 0; i < 3000; ++i) {
    const float sign = (i < 1500) == (i % 5 != 0) ? -1.F : 1.F;  // four of five agree
    hints.normals.insert(hints.normals.end(), {0.1F, 0.F, sign});
  }
  const OrientedCloud cloud = orient(xyz, hints);
  EXPECT_EQ(up(cloud, 0, 1500), 0.0);
  EXPECT_EQ(up(cloud, 1500, 3000), 1.0);
  for (const ComponentOrientationResult& c : cloud.report.components) {
    EXPECT_EQ(c.by, DecidedBy::HINTS);
    EXPECT_NEAR(c.confidence, 0.6F, 0.01F);
  }
}

TEST(Hints, NormalsOfAnySignSayNothing) {
  const std::vector<float> xyz = twoSquares(62);
  OrientationHints hints;
  for (int i = 0; i < 3000; ++i) {
    hints.normals.insert(hints.normals.end(), {0.F, 0.F, i % 5 < 3 ? -1.F : 1.F});
  }
  const OrientedCloud cloud = orient(xyz, hints);
  EXPECT_EQ(up(cloud, 0, 3000), 1.0) << "by convention";
  EXPECT_EQ(cloud.report.components[0].by, DecidedBy::NOTHING);
}

TEST(Hints, EachPointHasItsOwnViewpoint) {
  const std::vector<float> xyz = twoSquares(63);
  OrientationHints hints;
  for (int i = 0; i < 3000; ++i) {
    hints.viewpoints.insert(hints.viewpoints.end(), {0.5F, 0.5F, i < 1500 ? -2.F : 9.F});
  }
  const OrientedCloud cloud = orient(xyz, hints);
  EXPECT_EQ(up(cloud, 0, 1500), 0.0);
  EXPECT_EQ(up(cloud, 1500, 3000), 1.0);
}

TEST(Hints, OneSeedTurnsItsPart) {
  const std::vector<float> xyz = twoSquares(64);
  OrientationHints hints;
  hints.seeds = {{{0.4F, 0.6F, 0.1F}, {0.F, 0.2F, -1.F}}};
  const OrientedCloud cloud = orient(xyz, hints);
  EXPECT_EQ(up(cloud, 0, 1500), 0.0);
  EXPECT_EQ(up(cloud, 1500, 3000), 1.0);
}

TEST(Hints, ClosedSurfacesKnowTheirOutsideBetterThanAViewpoint) {
  const LabelledCloud cube = sample("cube", test::cube(), 6000, 65, 0.0);
  // So near that most of the cube turns its back to it.
  const OrientationHints near_face = seenFrom(0.5F, 0.5F, 1.5F);
  EXPECT_GE(shareOutward(orient(cube.xyz, near_face).normals, cube.normals), 0.999);
}

// Noise adds to what the winding number leaves of a closed surface. The middle sees all of a cube
// from within, but evenly.
TEST(Hints, SolidsInNoiseKnowTheirOutsideBetterThanAPlaceWithin) {
  for (const double noise : {0.2, 0.35, 0.5}) {
    const LabelledCloud cube = sample("cube", test::cube(), 6000, 65, noise);
    for (const OrientationHints& within :
         {seenFrom(0.5F, 0.5F, 0.5F), seenFrom(0.5F, 0.5F, 0.8F)}) {
      EXPECT_GE(shareOutward(orient(cube.xyz, within).normals, cube.normals), 0.995) << noise;
    }
  }
}

TEST(Hints, SeedsAndNormalsTurnClosedSurfacesInward) {
  const LabelledCloud cube = sample("cube", test::cube(), 6000, 66, 0.0);
  OrientationHints seeds;
  const auto at = [&](std::size_t i, std::size_t a) { return cube.xyz[4 * i + a]; };
  seeds.seeds = {
      {{at(0, 0), at(0, 1), at(0, 2)}, {-cube.normals[0], -cube.normals[1], -cube.normals[2]}}};
  EXPECT_LE(shareOutward(orient(cube.xyz, seeds).normals, cube.normals), 0.001);
  OrientationHints normals;
  for (std::size_t i = 0; i < cube.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) normals.normals.push_back(-cube.normals[4 * i + a]);
  }
  EXPECT_LE(shareOutward(orient(cube.xyz, normals).normals, cube.normals), 0.001);
}

// A shallow bowl: the winding number has an opinion, but it is one layer, which faces up.
TEST(Hints, TheKindOfSurfaceSaysWhetherTheViewpointCounts) {
  std::mt19937 rng(67);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<float> xyz;
  while (xyz.size() < 4 * 4000) {
    const double x = unit(rng);
    const double y = unit(rng);
    const double r2 = x * x + y * y;
    if (r2 > 1.0) continue;
    xyz.insert(xyz.end(),
               {static_cast<float>(x), static_cast<float>(y), static_cast<float>(r2), 0});
  }
  const std::size_t n = xyz.size() / 4;
  EXPECT_EQ(up(orient(xyz, {}), 0, n), 1.0);
  OrientationHints closed;
  closed.surface = SurfaceKind::CLOSED;
  EXPECT_EQ(up(orient(xyz, closed), 0, n), 0.0) << "out of the bowl is down";
  OrientationHints above = seenFrom(0.F, 0.F, 5.F);
  EXPECT_EQ(up(orient(xyz, above), 0, n), 1.0);
  above.surface = SurfaceKind::OPEN;
  EXPECT_EQ(up(orient(xyz, above), 0, n), 1.0);
  above.surface = SurfaceKind::CLOSED;
  EXPECT_EQ(up(orient(xyz, above), 0, n), 0.0);
}

}  // namespace
}  // namespace segorient::test
