// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Several stations in rooms whose walls are thinner than pieces of surface are wide.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "scanned_boxes.h"

namespace segorient::test {
namespace {

// Two rooms, .1 apart, with a desk in each.
TEST(PlacesOfPoints, BothSidesOfAThinWallFaceTheirRooms) {
  const std::vector<Box> rooms{{{0, 0, 0}, {5, 4, 2.6}},
                               {{5.1, 0, 0}, {9.6, 4, 2.6}},
                               {{1, 2.4, 0}, {2.6, 3.2, 0.8}},
                               {{7, 0.5, 0}, {8.2, 1.3, 0.8}}};
  Scans scans;
  scan(rooms, {1.2, 1.1, 1.4}, 56, 0.004, 1, scans);
  scan(rooms, {3.6, 2.8, 1.5}, 56, 0.004, 2, scans);
  scan(rooms, {6.1, 2.9, 1.4}, 56, 0.004, 3, scans);
  scan(rooms, {8.6, 1.9, 1.6}, 56, 0.004, 4, scans);
  const OrientedCloud cloud = orient(scans.xyz, {});
  ASSERT_EQ(cloud.report.sensors.sensors.size(), 4U) << cloud.report.sensors.why;
  EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.99);
}

// Rooms in rows, .1 apart, each with a desk.
std::vector<Box> floorOf(int across, int along) {
  std::vector<Box> out;
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < along; ++j) {
      const double x = 9.1 * i;
      const double y = 7.1 * j;
      out.push_back({{x, y, 0}, {x + 9, y + 7, 2.6}});
      out.push_back({{x + 1, y + 5, 0}, {x + 3, y + 6, 0.8}});
    }
  }
  return out;
}

TEST(PlacesOfPoints, MoreStationsThanTenAreFoundWhereTheyExplainNearlyAll) {
  const std::vector<Box> rooms = floorOf(4, 3);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-1.0, 1.0);
  Scans scans;
  for (unsigned s = 0; s < 12; ++s) {
    const Vector middle{5.0 + 9.1 * (s % 4), 3.0 + 7.1 * std::floor(s / 4), 1.5};
    scan(rooms, {middle[0] + shift(random), middle[1] + 0.3 * shift(random), 1.5}, 90, 0.004, s,
         scans);
  }
  const OrientedCloud cloud = orient(scans.xyz, {});
  ASSERT_EQ(cloud.report.sensors.sensors.size(), 12U) << cloud.report.sensors.why;
  EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.97);
}

// One that is carried about sees from some of its places what walls hide from others.
TEST(PlacesOfPoints, RoomsThatAScannerWasCarriedThroughAreSeenFromWithin) {
  const std::vector<Box> rooms = floorOf(3, 1);
  std::mt19937 random(6);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Scans scans;
  for (int pose = 0; pose < 36; ++pose) {
    const Vector from{9.1 * (pose / 12) + 1.0 + 7.0 * unit(random), 0.6 + 3.8 * unit(random), 1.5};
    for (int ray = 0; ray < 1200; ++ray) {
      Vector along{gauss(random), gauss(random), gauss(random)};
      const double length = std::hypot(along[0], along[1], along[2]);
      for (double& v : along) v /= length;
      Vector normal{};
      const double t = hit(rooms, from, along, normal) + 0.005 * gauss(random);
      addPoint(from, along, t, normal, pose, scans);
    }
  }
  EXPECT_GE(shareOutward(orient(scans.xyz, {}).normals, scans.normals), 0.93);
}

}  // namespace
}  // namespace segorient::test
