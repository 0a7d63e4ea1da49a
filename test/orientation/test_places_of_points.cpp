// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Several stations in rooms whose walls are thinner than pieces of surface are wide.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

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
  scan(rooms, {1.2, 1.1, 1.4}, 100, 0.004, 1, scans);
  scan(rooms, {3.6, 2.8, 1.5}, 100, 0.004, 2, scans);
  scan(rooms, {6.1, 2.9, 1.4}, 100, 0.004, 3, scans);
  scan(rooms, {8.6, 1.9, 1.6}, 100, 0.004, 4, scans);
  const OrientedCloud cloud = orient(scans.xyz, {});
  ASSERT_EQ(cloud.report.sensors.sensors.size(), 4U) << cloud.report.sensors.why;
  EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.99);
}

}  // namespace
}  // namespace segorient::test
