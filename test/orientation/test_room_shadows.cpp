// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Rooms whose densities were thinned away: what tells their side is what nobody in them saw.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/room_shadows.h"
#include "sensor_scans.h"
#include "sheet_fixture.h"
#include "voxel_thinned.h"

namespace segorient::test {
namespace {

// With a box that stands free.
Room furnished() {
  Room room;
  room.low = {2.6, 1.4, 0.0};
  room.high = {3.6, 2.4, 1.1};
  return room;
}

// Not from the origin, which is the first place that is looked at.
std::vector<float> roomSeenFrom(const std::vector<Vector>& stations, double edge) {
  Scan all(furnished());
  for (const Vector& station : stations) {
    const std::vector<float> rows = scanFrom(station, 1.0, furnished()).rows();
    all.rows().insert(all.rows().end(), rows.begin(), rows.end());
  }
  return thinned(all.view(), edge);
}

bool isRoom(const std::vector<float>& xyz) {
  const detail::FlatPoints flat(viewOf(xyz), 1);
  const std::vector<float> toward = detail::directionsInARoom(viewOf(xyz), flat, 1);
  EXPECT_TRUE(toward.empty() || toward.size() == xyz.size() / 4 * 3);
  return !toward.empty();
}

// Share of the points whose normal faces a place in the room, of those on its walls: the box turns
// some of its faces away.
double shareFacingIn(const std::vector<float>& xyz, const std::vector<float>& normals) {
  const Vector middle{3.0, 2.0, 2.0};
  const Room room = furnished();
  double walls = 0.0;
  double facing = 0.0;
  for (std::size_t i = 0; i < xyz.size() / 4; ++i) {
    bool on_wall = false;
    double along = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto v = static_cast<double>(xyz[4 * i + a]);
      on_wall = on_wall || v < 0.02 || v > room.size[a] - 0.02;
      along += static_cast<double>(normals[4 * i + a]) * (middle[a] - v);
    }
    walls += on_wall ? 1.0 : 0.0;
    facing += on_wall && along > 0.0 ? 1.0 : 0.0;
  }
  return facing / walls;
}

// What a room has and no body does: parts whose borders contradict each other.
void addPlants(std::vector<float>& xyz) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> leaf(0.0, 0.12);
  for (int plant = 0; plant < 12; ++plant) {
    const Vector foot{0.5 + 5.0 * unit(random), 0.5 + 3.0 * unit(random), 0.4};
    for (int i = 0; i < 120; ++i) {
      for (const double v : foot) xyz.push_back(static_cast<float>(v + leaf(random)));
      xyz.push_back(0.F);
    }
  }
}

TEST(RoomShadows, AThinnedRoomFacesWhoWasInIt) {
  for (const double edge : {0.1, 0.14, 0.18}) {
    for (const std::vector<Vector>& stations :
         {std::vector<Vector>{{1.2, 1.1, 1.6}}, {{1.1, 1.0, 1.5}, {1.3, 3.1, 1.7}}}) {
      std::vector<float> xyz = roomSeenFrom(stations, edge);
      EXPECT_TRUE(isRoom(xyz)) << edge;
      addPlants(xyz);
      const OrientedCloud cloud = orientCloud(viewOf(xyz), nullptr, {});
      EXPECT_TRUE(cloud.report.sensors.sensors.empty()) << cloud.report.sensors.why;
      EXPECT_GE(shareFacingIn(xyz, cloud.normals), 0.99) << edge << cloud.report.sensors.why;
    }
  }
}

// Beside a room that lies across the axes its box has corners that are deeper than the room.
TEST(RoomShadows, HowARoomLiesDoesNotMatter) {
  std::vector<float> xyz = roomSeenFrom({{1.2, 1.1, 1.6}}, 0.1);
  for (const double angle : {0.5, 0.8}) {
    std::vector<float> turned = xyz;
    for (std::size_t i = 0; i < xyz.size(); i += 4) {
      const auto x = static_cast<double>(xyz[i]);
      const auto y = static_cast<double>(xyz[i + 1]);
      turned[i] = static_cast<float>(std::cos(angle) * x - std::sin(angle) * y);
      turned[i + 1] = static_cast<float>(std::sin(angle) * x + std::cos(angle) * y);
    }
    EXPECT_TRUE(isRoom(turned)) << angle;
  }
}

// The bumps of its upper side hide little from within, and nothing of it is missing.
TEST(RoomShadows, ABlockWithAWavySideIsNoRoom) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto top = [](double x, double y) { return 0.25 * std::sin(5.0 * x) * std::cos(4.0 * y); };
  std::vector<float> xyz;
  const auto add = [&](double x, double y, double z) {
    for (const double v : {x, y, z, 0.0}) xyz.push_back(static_cast<float>(v));
  };
  for (int i = 0; i < 7000; ++i) {
    const double x = unit(random);
    const double y = unit(random);
    add(x, y, top(x, y));
    add(x, y, -0.8);
    if (i % 5 > 1) continue;
    for (const double side : {-1.0, 1.0}) {
      for (const bool along_x : {false, true}) {
        const double at = unit(random);
        const double px = along_x ? at : side;
        const double py = along_x ? side : at;
        add(px, py, -0.8 + 0.5 * (unit(random) + 1.0) * (top(px, py) + 0.8));
      }
    }
  }
  const OrientedCloud cloud = orientCloud(viewOf(xyz), nullptr, {});
  std::size_t up = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < xyz.size() / 4; ++i) {
    if (xyz[4 * i + 2] > -0.3F && std::fabs(xyz[4 * i]) < 0.9F &&
        std::fabs(xyz[4 * i + 1]) < 0.9F) {
      ++count;
      up += cloud.normals[4 * i + 2] > 0.F ? 1 : 0;
    }
  }
  EXPECT_GT(up, count * 99 / 100) << cloud.report.sensors.why;
}

TEST(RoomShadows, WhatContradictsItselfBoundsNoBody) {
  ComponentOrientationResult body;
  body.points = 900;
  body.contradiction = 0.01F;
  ComponentOrientationResult other;
  other.points = 100;
  other.contradiction = 0.1F;
  EXPECT_TRUE(detail::boundBodies({body, other}));
  other.contradiction = 0.5F;
  EXPECT_FALSE(detail::boundBodies({body, other}));
}

// The faces of boxes, all of them, evenly.
// \param noise standard deviation, along each axis
std::vector<float> wholeBoxes(const std::vector<Room>& boxes, double per_area = 150.0,
                              double noise = 0.0) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> error;  // a deviation of 0 is not allowed
  std::vector<float> xyz;
  for (const Room& box : boxes) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      const std::size_t c = (a + 2) % 3;
      const double area = (box.high[b] - box.low[b]) * (box.high[c] - box.low[c]);
      for (int i = 0; i < static_cast<int>(per_area * area); ++i) {
        for (const double at : {box.low[a], box.high[a]}) {
          Vector p{};
          p[a] = at;
          p[b] = box.low[b] + unit(random) * (box.high[b] - box.low[b]);
          p[c] = box.low[c] + unit(random) * (box.high[c] - box.low[c]);
          for (const double v : p) xyz.push_back(static_cast<float>(v + noise * error(random)));
          xyz.push_back(0.F);
        }
      }
    }
  }
  return xyz;
}

Room boxOf(const Vector& low, const Vector& high) {
  Room out;
  out.low = low;
  out.high = high;
  return out;
}

// What hides something is there, and so is what it hides.
TEST(RoomShadows, ABodyWithCavitiesIsNoRoom) {
  const Room outside = boxOf({0.0, 0.0, 0.0}, {6.0, 4.0, 3.0});
  const std::vector<float> convex = wholeBoxes({outside});
  const std::vector<float> hollow = wholeBoxes({outside, boxOf({2.6, 1.4, 1.0}, {3.6, 2.4, 2.0})});
  EXPECT_FALSE(isRoom(convex));
  EXPECT_FALSE(isRoom(hollow));
  const OrientedCloud cloud = orientCloud(viewOf(hollow), nullptr, {});
  EXPECT_TRUE(cloud.report.sensors.sensors.empty());
  EXPECT_LE(shareFacingIn(hollow, cloud.normals), 0.01);
}

TEST(RoomShadows, BodiesInNoiseAreNoRooms) {
  for (const double noise : {0.0, 0.01, 0.02}) {
    EXPECT_FALSE(isRoom(sample("bracket", bracket(), 12000, 71, noise).xyz)) << noise;
    EXPECT_FALSE(isRoom(sample("cube", test::cube(), 6000, 70, noise).xyz)) << noise;
  }
}

// From a place in one of them the others are there, but noise takes what covers them off surfaces.
TEST(RoomShadows, StackedBoxesInNoiseAreNoRooms) {
  constexpr double kPerArea = 417.0;
  const double spacing = 1.0 / std::sqrt(kPerArea);
  for (const double noise : {0.2, 0.3, 0.4}) {
    std::vector<Room> boxes;
    for (const double level : {0.0, 1.0, 2.0}) {
      boxes.push_back(boxOf({0.0, 0.0, level}, {1.0, 1.0, level + 1.0}));
    }
    EXPECT_FALSE(isRoom(wholeBoxes(boxes, kPerArea, noise * spacing))) << noise;
  }
}

TEST(RoomShadows, NothingTellsNothing) {
  EXPECT_FALSE(isRoom({}));
  EXPECT_FALSE(isRoom(std::vector<float>(4, 1.F)));
  EXPECT_FALSE(isRoom(std::vector<float>(400, 1.F)));
  std::vector<float> line;
  for (int i = 0; i < 200; ++i)
    line.insert(line.end(), {0.1F * static_cast<float>(i), 0.F, 0.F, 0.F});
  EXPECT_FALSE(isRoom(line));
}

}  // namespace
}  // namespace segorient::test
