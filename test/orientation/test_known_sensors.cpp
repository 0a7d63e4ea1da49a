// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Sensors that are known are facts: scans of boxes by rays, whose true normals face the sensor.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "orientation/sensors/known_sensors.h"
#include "scanned_boxes.h"

namespace segorient::test {
namespace {

TEST(KnownSensors, ARoomFacesTheStationWithinIt) {
  const Vector station{1.1, 0.9, 1.4};
  const Scans scans = room(station);
  for (const OrientationHints& hints : {seenFrom(station), eachItsOwn(scans)}) {
    const OrientedCloud cloud = orient(scans.xyz, hints);
    EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.998);
    ASSERT_EQ(cloud.report.known_sensors.size(), 1U);
    EXPECT_TRUE(cloud.report.known_sensors[0].used);
    EXPECT_EQ(cloud.report.known_sensors[0].seen, scans.size());
    EXPECT_LT(cloud.report.known_sensors[0].hidden, 0.05F);
    EXPECT_LT(cloud.report.known_sensors[0].density, 0.5F);
    EXPECT_NEAR(cloud.report.known_sensors[0].position[2], 1.4F, 1e-5F);
  }
}

TEST(KnownSensors, EachSideOfAThinWallFacesWhoSawIt) {
  // 1 thick where points are about 3 apart.
  const std::vector<Box> wall{{{-40, -0.5, -30}, {40, 0.5, 30}}};
  Scans scans;
  scan(wall, {5, -50, 3}, 90, 0.05, 2, scans);
  scan(wall, {-7, 50, -4}, 90, 0.05, 3, scans);
  const OrientedCloud cloud = orient(scans.xyz, eachItsOwn(scans));
  EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.998);
  ASSERT_EQ(cloud.report.known_sensors.size(), 2U);
}

// The poses of two across from each other are mixed up.
TEST(KnownSensors, MixedUpPosesAreFoundAndLeftToTheSurface) {
  const Around around;
  const OrientedCloud right = orient(around.scans.xyz, eachItsOwn(around.scans));
  for (const KnownSensor& s : right.report.known_sensors) EXPECT_TRUE(s.used) << s.position[0];
  EXPECT_GE(shareOutward(right.normals, around.scans.normals), 0.998);
  const OrientedCloud mixed = orient(around.scans.xyz, around.withPoses({2, 1, 0, 3}));
  EXPECT_GE(shareOutward(mixed.normals, around.scans.normals), 0.998);
  for (const KnownSensor& s : mixed.report.known_sensors) {
    EXPECT_TRUE(s.used || std::fabs(s.position[0]) > 3.F);
    EXPECT_EQ(s.confirmed, s.used);
    EXPECT_EQ(s.seen, s.used ? s.points : 0U);
  }
  const auto refused =
      std::count_if(mixed.report.known_sensors.begin(), mixed.report.known_sensors.end(),
                    [](const KnownSensor& s) { return !s.used; });
  EXPECT_EQ(refused, 2);
}

// Where most poses are refused, none is followed that nothing confirms.
TEST(KnownSensors, PosesThatAreAllMixedUpTurnNothing) {
  const Around around;
  for (const std::array<int, 4>& poses :
       {std::array<int, 4>{1, 2, 3, 0}, std::array<int, 4>{3, 0, 1, 2}}) {
    const OrientedCloud mixed = orient(around.scans.xyz, around.withPoses(poses));
    EXPECT_GE(shareOutward(mixed.normals, around.scans.normals), 0.998);
    for (const KnownSensor& s : mixed.report.known_sensors) EXPECT_FALSE(s.used) << s.position[0];
  }
}

// A scanner of one upright plane that goes along a passage: single profiles have no density.
TEST(KnownSensors, ProfilesOfFewPointsAreLookedAtTogether) {
  const std::vector<Box> passage{{{-1, -2, -1.6}, {21, 2, 2}},
                                 {{6, 0.8, -1.6}, {7, 1.6, 0.2}},
                                 {{13, -1.7, -1.6}, {14.5, -0.9, 0.6}}};
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  Scans scans;
  constexpr int kRays = 260;
  for (int pose = 0; pose < 250; ++pose) {
    const Vector from{0.5 + 0.08 * pose, 0.1, 0.0};
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2.0 * M_PI * (ray + 0.3) / kRays;
      const Vector along{1e-6, std::cos(angle), std::sin(angle)};
      Vector normal{};
      const double t = hit(passage, from, along, normal) + noise(random);
      addPoint(from, along, t, normal, pose, scans);
    }
  }
  const OrientedCloud cloud = orient(scans.xyz, eachItsOwn(scans));
  EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.998);
  ASSERT_EQ(cloud.report.known_sensors.size(), 1U);
  EXPECT_TRUE(cloud.report.known_sensors[0].moving);
  EXPECT_TRUE(cloud.report.known_sensors[0].used);
}

TEST(KnownSensors, AViewpointInsideASolidChangesNothingAndIsReported) {
  const LabelledCloud cube = sample("cube", test::cube(), 6000, 70, 0.0);
  const OrientedCloud free = orient(cube.xyz, {});
  const OrientedCloud cloud = orient(cube.xyz, seenFrom({0.4, 0.55, 0.5}));
  EXPECT_EQ(cloud.normals, free.normals);
  EXPECT_TRUE(free.report.known_sensors.empty());
  ASSERT_EQ(cloud.report.known_sensors.size(), 1U);
  EXPECT_FALSE(cloud.report.known_sensors[0].used);
  EXPECT_EQ(cloud.report.known_sensors[0].seen, 0U);
}

TEST(KnownSensors, OneViewpointDoesNotTurnTheFarSideOfAMergedSolid) {
  const LabelledCloud solid = sample("bracket", bracket(), 12000, 71, 0.0);
  const OrientedCloud free = orient(solid.xyz, {});
  const OrientedCloud cloud = orient(solid.xyz, seenFrom({6.0, 5.0, 7.0}));
  EXPECT_GE(shareOutward(free.normals, solid.normals), 0.99);
  EXPECT_GE(shareOutward(cloud.normals, solid.normals),
            shareOutward(free.normals, solid.normals) - 0.001);
  ASSERT_EQ(cloud.report.known_sensors.size(), 1U);
  EXPECT_TRUE(cloud.report.known_sensors[0].used);
  EXPECT_GT(cloud.report.known_sensors[0].hidden, 0.1F);
}

// Stray points open what is closed to the winding number, and the place then had its way with it.
TEST(KnownSensors, APlaceThatHidesMostOfACloudChangesNothingAndIsReported) {
  LabelledCloud solid = sample("bracket", bracket(), 12000, 72, 0.0);
  std::mt19937 rng(8);
  std::uniform_real_distribution<float> anywhere(-1.2F, 1.2F);
  std::array<float, 3> low{1e9F, 1e9F, 1e9F};
  std::array<float, 3> high{-1e9F, -1e9F, -1e9F};
  for (std::size_t i = 0; i < solid.xyz.size() / 4; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], solid.xyz[4 * i + a]);
      high[a] = std::max(high[a], solid.xyz[4 * i + a]);
    }
  }
  for (int k = 0; k < 2000; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      solid.xyz.push_back(0.5F * (low[a] + high[a]) + anywhere(rng) * 0.5F * (high[a] - low[a]));
    }
    solid.xyz.push_back(0.F);
  }
  const OrientedCloud free = orient(solid.xyz, {});
  const auto middle = [&](std::size_t a) { return 0.5 * static_cast<double>(low[a] + high[a]); };
  const OrientedCloud inside = orient(solid.xyz, seenFrom({middle(0), middle(1), middle(2)}));
  EXPECT_EQ(inside.normals, free.normals);
  ASSERT_EQ(inside.report.known_sensors.size(), 1U);
  EXPECT_EQ(inside.report.known_sensors[0].seen, 0U);
  EXPECT_GT(inside.report.known_sensors[0].hidden, 1.F / 3.F);
}

// What hides what depends on where one stands, not on how far away that is.
TEST(KnownSensors, FromFarAwayABodyHidesItsBackAsWell) {
  std::mt19937 rng(9);
  std::normal_distribution<float> gauss;
  std::vector<float> xyz;
  while (xyz.size() < std::size_t{4} * 8000) {  // a ball without its cap: open
    const float v[3] = {gauss(rng), gauss(rng), gauss(rng)};
    const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (v[2] > 0.8F * length) continue;
    for (const float c : v) xyz.push_back(c / length);
    xyz.push_back(0.F);
  }
  for (const double distance : {20.0, 100.0, 1e6}) {
    const OrientedCloud cloud = orient(xyz, seenFrom({0.0, distance, 0.0}));
    ASSERT_EQ(cloud.report.known_sensors.size(), 1U);
    EXPECT_GT(cloud.report.known_sensors[0].hidden, 0.3F) << distance;
    // Nor is that the place of an open surface, whoever says that it is open.
    OrientationHints told = seenFrom({0.0, distance, 0.0});
    told.surface = SurfaceKind::OPEN;
    EXPECT_GE(shareOutward(orient(xyz, told).normals, xyz), 0.99) << distance;
  }
}

TEST(KnownSensors, OnePlaceGivesWayToSensorsThatAreFoundElsewhere) {
  const Scans scans = room({1.1, 0.9, 1.4});
  const OrientedCloud free = orient(scans.xyz, {});
  for (const Vector& place :
       {Vector{8.0, 2.0, 1.0}, Vector{2.0, 1.5, -9.0}, Vector{2.5, 1.5, 0.4}}) {
    const OrientedCloud cloud = orient(scans.xyz, seenFrom(place));
    EXPECT_GE(shareOutward(cloud.normals, scans.normals),
              shareOutward(free.normals, scans.normals) - 0.01);
    ASSERT_FALSE(cloud.report.known_sensors.empty());
    EXPECT_FALSE(cloud.report.known_sensors[0].used) << place[0] << " " << place[2];
  }
}

TEST(KnownSensors, APlaceThatIsNoPlaceIsReportedAndHidesNoneThatIsFound) {
  const Scans scans = room({1.1, 0.9, 1.4});
  const OrientedCloud cloud =
      orient(scans.xyz, seenFrom({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
  EXPECT_EQ(cloud.normals, orient(scans.xyz, {}).normals);
  ASSERT_FALSE(cloud.report.known_sensors.empty());
  EXPECT_FALSE(cloud.report.known_sensors[0].used);
}

TEST(KnownSensors, PointsWithoutOneFollowTheSurfaceAround) {
  const Scans scans = room({1.1, 0.9, 1.4});
  OrientationHints hints = eachItsOwn(scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i % 10 < 7) hints.viewpoints[3 * i + i % 3] = std::numeric_limits<float>::quiet_NaN();
  }
  const OrientedCloud cloud = orient(scans.xyz, hints);
  EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.998);
  for (const KnownSensor& s : cloud.report.known_sensors) {
    EXPECT_TRUE(s.used);
    EXPECT_NEAR(s.position[2], 1.4F, 0.1F) << "given, or found for the others";
  }
  hints.viewpoints.assign(3 * scans.size(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(orient(scans.xyz, hints).normals, orient(scans.xyz, {}).normals);
}

TEST(KnownSensors, RowsMayComeInAnyOrder) {
  const Scans scans = room({1.1, 0.9, 1.4});
  const OrientedCloud cloud = orient(scans.xyz, eachItsOwn(scans));
  Scans turned;
  for (std::size_t k = scans.size(); k-- > 0;) {
    turned.xyz.insert(turned.xyz.end(), &scans.xyz[4 * k], &scans.xyz[4 * k] + 4);
    turned.sensors.insert(turned.sensors.end(), &scans.sensors[3 * k], &scans.sensors[3 * k] + 3);
  }
  const OrientedCloud other = orient(turned.xyz, eachItsOwn(turned));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_EQ(cloud.normals[4 * i + a], other.normals[4 * (scans.size() - 1 - i) + a]) << i;
    }
  }
}

TEST(KnownSensors, BothSidesAreSeenIfOneIsNotFollowedForThat) {
  const auto follow = [](bool used, float contrary) {
    KnownSensor out;
    out.used = used;
    out.contrary = contrary;
    return out;
  };
  const KnownSensor good = follow(true, 0.F);
  EXPECT_FALSE(detail::seeBothSides({}));
  EXPECT_FALSE(detail::seeBothSides({good, good}));
  EXPECT_TRUE(detail::seeBothSides({good, follow(false, 0.05F)}));
  // It was believed all the same, or was refused for another reason.
  EXPECT_FALSE(detail::seeBothSides({good, follow(true, 0.05F)}));
  EXPECT_FALSE(detail::seeBothSides({good, follow(false, 0.F)}));
}

}  // namespace
}  // namespace segorient::test
