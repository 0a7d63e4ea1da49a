// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What steps of depth say of a place, and clouds that were thinned after they were seen from one.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <vector>

#include "orientation/sensors/shadows.h"
#include "sensor_scans.h"
#include "sheet_fixture.h"
#include "voxel_thinned.h"

namespace segorient::test {
namespace {

// With a box that stands free: it hides a part of the floor and of a wall.
Room furnished() {
  Room room;
  room.low = {3.0, 1.4, 0.0};
  room.high = {3.8, 2.2, 1.3};
  return room;
}

std::array<float, 3> inFloat(const Vector& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// Of the points of rooms, all of which a station saw.
double shareFacing(const std::vector<float>& xyz, const std::vector<float>& normals,
                   const Vector& place) {
  std::size_t facing = 0;
  for (std::size_t i = 0; i < xyz.size() / 4; ++i) {
    double along = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      along += static_cast<double>(normals[4 * i + a]) *
               (place[a] - static_cast<double>(xyz[4 * i + a]));
    }
    facing += along > 0.0 ? 1 : 0;
  }
  return static_cast<double>(facing) / (static_cast<double>(xyz.size()) / 4.0);
}

OrientedCloud orient(const std::vector<float>& xyz, const Vector* place) {
  PipelineOptions options;
  OrientationHints hints;
  if (place != nullptr) {
    hints.has_viewpoint = true;
    hints.viewpoint = inFloat(*place);
  }
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  return orientCloud(viewOf(xyz), nullptr, options);
}

TEST(Shadows, WhatASensorSawEndsThere) {
  const Vector eye{0.4, 1.2, 1.2};
  const Scan scan = viewFrom(eye, 0.1, furnished());
  for (const double edge : {0.04, 0.07, 0.1}) {
    const std::vector<float> xyz = thinned(scan.view(), edge);
    const detail::Shadows shadows = detail::findShadows(viewOf(xyz), inFloat(eye), 1);
    EXPECT_TRUE(shadows.confirm()) << edge << " " << shadows.steps << " " << shadows.covered;
    EXPECT_FALSE(shadows.deny());
    EXPECT_FALSE(shadows.contradict());
    const detail::Shadows elsewhere = detail::findShadows(viewOf(xyz), {9.F, 2.F, 1.F}, 1);
    EXPECT_FALSE(elsewhere.allow());
    EXPECT_TRUE(elsewhere.deny()) << edge << " " << elsewhere.steps << " " << elsewhere.covered;
  }
}

TEST(Shadows, ABodyGoesOnBehindItself) {
  const LabelledCloud solid = sample("bracket", bracket(), 12000, 71, 0.0);
  for (const Vector& place : {Vector{6.0, 5.0, 7.0}, Vector{-5.0, 3.0, 1.0}}) {
    const detail::Shadows shadows = detail::findShadows(viewOf(solid.xyz), inFloat(place), 1);
    EXPECT_TRUE(shadows.deny()) << place[0] << " " << shadows.steps << " " << shadows.covered;
    EXPECT_FALSE(shadows.allow());
  }
  const LabelledCloud round = sample("cube", test::cube(), 6000, 70, 0.0);
  const detail::Shadows inside = detail::findShadows(viewOf(round.xyz), {0.4F, 0.55F, 0.5F}, 1);
  EXPECT_FALSE(inside.confirm() || inside.deny() || inside.reveal());
  EXPECT_EQ(inside.open, 0.F);
}

// Flat roofs over flat ground, nothing below the roofs, as seen from far above.
std::vector<float> city(float height) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> place(-45.F, 45.F);
  std::uniform_real_distribution<float> size(2.F, 5.F);
  std::uniform_real_distribution<float> storeys(4.F, 20.F);
  std::uniform_real_distribution<float> anywhere(-50.F, 50.F);
  std::normal_distribution<float> noise(0.F, 0.03F);
  struct House {
    float x, y, half, roof;
  };
  std::vector<House> houses;
  for (int h = 0; h < 30; ++h) houses.push_back({place(rng), place(rng), size(rng), storeys(rng)});
  std::vector<float> xyz;
  for (int i = 0; i < 40000; ++i) {
    const float x = anywhere(rng);
    const float y = anywhere(rng);
    float z = 0.F;
    for (const House& h : houses) {
      if (std::max(std::fabs(x - h.x), std::fabs(y - h.y)) < h.half) z = h.roof;
    }
    for (const float v : {x, y, height + z + noise(rng), 0.F}) xyz.push_back(v);
  }
  return xyz;
}

// Vertices by latitude and longitude have the density of a scan from within; but no tripod left a
// hole, and nothing hides anything.
TEST(Shadows, VerticesByLatitudeAreNoScanFromWithin) {
  constexpr int kAround = 160;
  constexpr int kRings = 60;
  for (const double height : {2.0, 3.0, 4.5}) {
    // More would draw rings so far apart that there seem to be gaps between them.
    for (const double bump : {0.0, height > 2.0 ? 0.0 : 0.3}) {
      std::vector<float> xyz;
      for (int i = 0; i < kAround * kRings; ++i) {
        const double latitude = kPi * (0.5 + i / kAround) / kRings;
        const double longitude = 2.0 * kPi * (i % kAround) / kAround;
        const Vector u{std::sin(latitude) * std::cos(longitude),
                       std::sin(latitude) * std::sin(longitude), std::cos(latitude)};
        const double radius = 1.0 + bump * u[2];
        xyz.insert(xyz.end(), {static_cast<float>(20.0 + 2.0 * radius * u[0]),
                               static_cast<float>(7.0 + 2.0 * radius * u[1]),
                               static_cast<float>(7.0 + height * radius * u[2]), 0.F});
      }
      const SensorReport report = findSensors(viewOf(xyz));
      EXPECT_FALSE(report.sure()) << height << ", bump " << bump << ": " << report.why;
      EXPECT_TRUE(report.directions.empty());
    }
  }
}

// A plate whose back one scanner saw a part of, and another its front: the steps are few.
TEST(Shadows, AFewPointsBehindOthersContradict) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto plate = [&](double low, double high, double z, int count, std::vector<float>& xyz) {
    for (int i = 0; i < count; ++i) {
      for (int a = 0; a < 2; ++a)
        xyz.push_back(static_cast<float>(low + (high - low) * unit(random)));
      xyz.insert(xyz.end(), {static_cast<float>(z), 0.F});
    }
  };
  const Vector above{0.5, 0.5, 3.0};
  std::vector<float> xyz;
  plate(0.0, 1.0, 0.0, 9000, xyz);
  EXPECT_FALSE(detail::findShadows(viewOf(xyz), inFloat(above), 1).contradict());
  plate(0.42, 0.58, -0.3, 250, xyz);
  const detail::Shadows shadows = detail::findShadows(viewOf(xyz), inFloat(above), 1);
  EXPECT_TRUE(shadows.contradict()) << shadows.steps << " " << shadows.covered;
  EXPECT_FALSE(shadows.deny());
}

// A plate lies on the plane z = 0 and against the others, as parts do in the files they are drawn
// in, with a corner cut off: whoever looks along its faces sees holes in them as steps.
TEST(Shadows, ACutCornerInTheOriginSeesNothingOfAPlate) {
  constexpr double kWidth = 16.0;
  constexpr double kLength = 24.0;
  constexpr double kCut = 2.0;
  constexpr double kHole = 0.4;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<float> xyz;
  const auto add = [&xyz](double x, double y, double z) {
    bool kept = x + y > kCut;
    for (const double a : {4.0, 12.0}) {
      for (const double b : {6.0, 18.0}) kept = kept && std::hypot(x - a, y - b) > kHole;
    }
    if (!kept) return;
    for (const double v : {x, y, z, 0.0}) xyz.push_back(static_cast<float>(v));
  };
  for (int i = 0; i < 11500; ++i) {
    for (const double z : {0.0, 1.0}) add(kWidth * unit(random), kLength * unit(random), z);
  }
  for (int i = 0; i < 480; ++i) {
    for (const double y : {0.0, kLength}) add(kWidth * unit(random), y, unit(random));
  }
  for (int i = 0; i < 720; ++i) {
    for (const double x : {0.0, kWidth}) add(x, kLength * unit(random), unit(random));
  }
  const PointView points{xyz.data(), 4, xyz.size() / 4};
  EXPECT_FALSE(detail::findShadows(points, {0.F, 0.F, 0.F}, 0).confirm());
  const OrientedCloud found = orient(xyz, nullptr);
  EXPECT_TRUE(found.report.sensors.sensors.empty());
}

TEST(Shadows, FarAboveAndFarBelowLookAlike) {
  for (const float height : {0.F, 2000.F}) {
    const std::vector<float> xyz = city(height);
    const detail::Shadows below = detail::findShadows(viewOf(xyz), {0.F, 0.F, height - 2000.F}, 1);
    EXPECT_TRUE(below.better_across) << height << " " << below.steps << " " << below.covered;
    EXPECT_FALSE(below.confirm() || below.reveal()) << height;
    const detail::Shadows above = detail::findShadows(viewOf(xyz), {0.F, 0.F, height + 2000.F}, 1);
    EXPECT_FALSE(above.better_across) << height << " " << above.steps << " " << above.covered;
    const OrientedCloud cloud = orient(xyz, nullptr);
    EXPECT_GE(shareFacing(xyz, cloud.normals, {0.0, 0.0, 1e6}), 0.99) << height;
  }
}

// A sensor's own tripod, or dust before it.
TEST(Shadows, AStrayPointBeforeThePlaceEnclosesNothing) {
  const Vector eye{0.4, 1.2, 1.2};
  std::vector<float> xyz = thinned(viewFrom(eye, 0.1, furnished()).view(), 0.07);
  EXPECT_TRUE(detail::findShadows(viewOf(xyz), inFloat(eye), 1).reveal());
  for (const float v : {0.45F, 1.2F, 1.2F, 0.F}) xyz.push_back(v);
  EXPECT_TRUE(detail::findShadows(viewOf(xyz), inFloat(eye), 1).reveal());
}

// Each place of a room hides something; of a rod's axis none does, where there are gaps or not.
TEST(Shadows, PlacesThatNothingIsHiddenFromAreAtOneBody) {
  detail::Shadows free;
  free.open = 0.01F;
  detail::Shadows beside = free;
  beside.open = 0.03F;
  detail::Shadows hides = free;
  hides.steps = 0.06F;
  EXPECT_TRUE(detail::areAtOneBody({free, free, hides}, false, false));
  EXPECT_FALSE(detail::areAtOneBody({free, hides, hides}, false, false));
  EXPECT_FALSE(detail::areAtOneBody({beside, beside, beside}, false, false));
  EXPECT_TRUE(detail::areAtOneBody({beside, beside, beside}, false, true));
  EXPECT_FALSE(detail::areAtOneBody({beside, beside, beside}, true, true));
  detail::Shadows above;
  above.open = 0.8F;
  EXPECT_TRUE(detail::areAtOneBody({above, above, above}, false, true));
  EXPECT_TRUE(detail::areAtOneBody({above, above, beside}, true, true));
  EXPECT_FALSE(detail::areAtOneBody({above, above, above}, true, false));
  free.open = 0.F;
  hides.open = 0.F;
  EXPECT_TRUE(free.enclose());
  EXPECT_FALSE(beside.enclose() || hides.enclose() || detail::Shadows{}.enclose());
}

TEST(Shadows, NothingTellsNothing) {
  const detail::Shadows none = detail::findShadows({nullptr, 4, 0}, {0.F, 0.F, 0.F}, 1);
  EXPECT_FALSE(none.confirm() || none.deny() || none.allow() || none.reveal());
  const std::vector<float> one(4, 1.F);
  const detail::Shadows few = detail::findShadows(viewOf(one), {1.F, 1.F, 1.F}, 1);
  EXPECT_FALSE(few.confirm() || few.deny() || few.allow() || few.reveal());
}

// Rooms nearly close, so that a place that densities did not confirm was not believed.
TEST(Shadows, AThinnedRoomFacesItsStation) {
  const Vector station{1.2, 1.1, 1.6};
  for (const Room& room : {Room{}, furnished()}) {
    const Scan scan = scanFrom(station, 1.2, room);
    for (const double edge : {0.08, 0.12, 0.16}) {
      const std::vector<float> xyz = thinned(scan.view(), edge);
      const OrientedCloud cloud = orient(xyz, &station);
      EXPECT_GE(shareFacing(xyz, cloud.normals, station), 0.998) << edge;
      ASSERT_EQ(cloud.report.known_sensors.size(), 1U);
      EXPECT_TRUE(cloud.report.known_sensors[0].used) << edge;
    }
  }
}

TEST(Shadows, AThinnedViewFromTheOriginIsFound) {
  const Vector eye{0.4, 1.2, 1.2};
  Scan view = viewFrom(eye, 0.1, furnished());
  view.move({-eye[0], -eye[1], -eye[2]});
  const std::vector<float> xyz = thinned(view.view(), 0.07);
  const OrientedCloud cloud = orient(xyz, nullptr);
  ASSERT_EQ(cloud.report.sensors.sensors.size(), 1U);
  EXPECT_EQ(cloud.report.sensors.sensors[0].evidence, SensorEvidence::SHADOWS);
  EXPECT_STREQ(toString(SensorEvidence::SHADOWS), "shadows");
  EXPECT_TRUE(cloud.report.sensors.sensors[0].suggested);
  EXPECT_LT(cloud.report.sensors.sensors[0].cost_ratio, 0.2F);
  EXPECT_GE(shareFacing(xyz, cloud.normals, {0.0, 0.0, 0.0}), 0.998);
}

// Of a ring seen from its middle, the inner half hides the outer one. Noise leaves few points that
// show to be on surfaces, but no gap in what they make.
TEST(Shadows, NoiseOpensNoGapInWhatABodyHides) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> angle(0.0, 2.0 * kPi);
    std::normal_distribution<double> noise(0.0, 0.02);
    std::vector<float> xyz;
    while (xyz.size() < std::size_t{4} * 8000) {
      const double u = angle(random);
      const double v = angle(random);
      const double r = 0.8 + 0.45 * std::cos(v);
      if (std::uniform_real_distribution<double>(0.0, 1.25)(random) > r) continue;
      for (const double x : {r * std::cos(u), r * std::sin(u), 0.45 * std::sin(v)}) {
        xyz.push_back(static_cast<float>(x + noise(random)));
      }
      xyz.push_back(0.F);
    }
    const detail::Shadows shadows = detail::findShadows(viewOf(xyz), {0.F, 0.F, 0.F}, 0);
    ASSERT_GT(shadows.steps, 0.05F);
    EXPECT_GT(shadows.hidden, 0.9F * shadows.steps);
    EXPECT_FALSE(shadows.reveal());
    EXPECT_FALSE(shadows.allow());
    EXPECT_TRUE(findSensors(viewOf(xyz)).sensors.empty());
  }
}

}  // namespace
}  // namespace segorient::test
