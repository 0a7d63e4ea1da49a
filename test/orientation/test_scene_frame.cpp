// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Sensors are found in whatever coordinates a cloud comes.
#include <gtest/gtest.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "orientation/sensors/scene_frame.h"
#include "sensor_scans.h"

namespace segorient {
namespace {

// About (1, 2, 2) / 3 by 50 degrees, so that no coordinate axis stays near another one.
Vector turned(const Vector& v) {
  constexpr Vector kAbout{1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0};
  const double cosine = std::cos(50.0 * kPi / 180.0);
  const double sine = std::sin(50.0 * kPi / 180.0);
  const double along = kAbout[0] * v[0] + kAbout[1] * v[1] + kAbout[2] * v[2];
  Vector out{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3;
    const std::size_t c = (a + 2) % 3;
    out[a] = cosine * v[a] + sine * (kAbout[b] * v[c] - kAbout[c] * v[b]) +
             (1.0 - cosine) * along * kAbout[a];
  }
  return out;
}

void turn(Scan& scan) {
  std::vector<float>& rows = scan.rows();
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    const Vector p = turned({rows[i], rows[i + 1], rows[i + 2]});
    for (std::size_t a = 0; a < 3; ++a) rows[i + a] = static_cast<float>(p[a]);
  }
}

void add(const Vector& center, const Vector& normal, bool is_turned,
         detail::DensityPatches& patches) {
  float p[3];
  float n[3];
  const Vector q = is_turned ? turned(center) : center;
  const Vector m = is_turned ? turned(normal) : normal;
  for (std::size_t a = 0; a < 3; ++a) {
    p[a] = static_cast<float>(q[a]);
    n[a] = static_cast<float>(m[a]);
  }
  patches.add(p, n, 1.F);
}

// A street: more pieces on its facades, which are four planes, than on the ground, which is one.
detail::DensityPatches street(bool is_turned) {
  detail::DensityPatches out;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    add({40.0 * unit(random), 10.0 * unit(random), 0.0}, {0.0, 0.0, 1.0}, is_turned, out);
  }
  for (int i = 0; i < 600; ++i) {
    const double facade[] = {0.0, -3.0, 10.0, 13.0};
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    add({40.0 * unit(random), facade[i % 4], 8.0 * unit(random)}, {0.0, side, 0.0}, is_turned, out);
  }
  out.setSparsity();
  return out;
}

TEST(SceneFrame, StandsOnTheLargestPlane) {
  const detail::SceneFrame frame(street(true));
  EXPECT_FALSE(frame.isOwn());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vector unit{0.0, 0.0, 0.0};
    unit[axis] = 1.0;
    const Vector in_cloud = turned(unit);
    const std::array<float, 3> in_frame =
        frame.into({static_cast<float>(in_cloud[0]), static_cast<float>(in_cloud[1]),
                    static_cast<float>(in_cloud[2])});
    // Facades face x or y.
    const auto largest = static_cast<std::size_t>(
        std::max_element(in_frame.begin(), in_frame.end(),
                         [](float a, float b) { return std::fabs(a) < std::fabs(b); }) -
        in_frame.begin());
    EXPECT_EQ(largest == 2, axis == 2);
    EXPECT_GT(std::fabs(in_frame[largest]), 0.9999F);
    const std::array<float, 3> back = frame.back(in_frame);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(back[a], in_cloud[a], 1e-6);
  }
}

TEST(SceneFrame, IsTheClouds) {
  EXPECT_TRUE(detail::SceneFrame(street(false)).isOwn());
  EXPECT_TRUE(detail::SceneFrame(detail::DensityPatches{}).isOwn());
  detail::DensityPatches ball;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    Vector v{normal(random), normal(random), normal(random)};
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (double& x : v) x /= length;
    add(v, v, false, ball);
  }
  ball.setSparsity();
  EXPECT_TRUE(detail::SceneFrame(ball).isOwn());
}

TEST(SceneFrame, StationsOfATurnedRoomAreFound) {
  const std::vector<Vector> all{{1.0, 3.2, 1.5}, {5.2, 3.0, 1.4}, {3.0, 0.8, 1.6}};
  for (const std::size_t count : {std::size_t{1}, all.size()}) {
    Scan scan;
    for (std::size_t s = 0; s < count; ++s) {
      Scan one = scanFrom(all[s], 1.8);
      scan.rows().insert(scan.rows().end(), one.rows().begin(), one.rows().end());
    }
    turn(scan);
    const SensorReport report = findSensors(scan.view());
    ASSERT_EQ(report.sensors.size(), count) << report.why;
    for (std::size_t s = 0; s < count; ++s) {
      double nearest = 1e30;
      for (const FoundSensor& found : report.sensors) {
        nearest = std::min(nearest, distanceTo(found, turned(all[s])));
        EXPECT_TRUE(found.sure);
        const Vector up = turned({0.0, 0.0, 1.0});
        double along = 0.0;
        for (std::size_t a = 0; a < 3; ++a) along += up[a] * static_cast<double>(found.axis[a]);
        EXPECT_GT(std::fabs(along), 0.99);
      }
      EXPECT_LT(nearest, 0.1);
    }
  }
}

TEST(SceneFrame, ScannersOnTheirWayThroughATurnedStreetAreFound) {
  std::vector<Vector> poses;
  for (int i = 0; i < 12; ++i) poses.push_back({6.0 + 1.2 * i, 2.7 + .03 * i, 1.8});
  Scan scan = scanAlong(poses, {{50.0, 6.0, 5.0}, {30.0, 0.0, 0.0}, {34.0, 2.0, 2.0}});
  turn(scan);
  const SensorReport report = findSensors(scan.view());
  ASSERT_GT(report.sensors.size(), 1U) << report.why;
  std::size_t near = 0;
  for (const FoundSensor& s : report.sensors) {
    double nearest = 1e30;
    for (const Vector& pose : poses) nearest = std::min(nearest, distanceTo(s, turned(pose)));
    if (nearest < 1.1) near += s.points;  // as where nothing is turned
  }
  // An end of the way may be some metres off, as the last few poses say little.
  EXPECT_GT(static_cast<double>(near), 0.8 * static_cast<double>(scan.view().size));
}

// A town on a hillside, whose largest plane is not level: seen from above along the cloud's z.
TEST(SceneFrame, AHillsideIsSeenFromAboveAllTheSame) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  while (rows.size() < 90000) {
    const float x = 10.F * unit(random);
    const float y = 10.F * unit(random);
    if (std::fmod(x, 2.F) > 0.5F && unit(random) > 0.4F) continue;  // strips, as aircraft fly
    const bool roof = std::fmod(x, 2.F) < 0.7F && std::fmod(y, 2.F) < 0.7F;
    rows.insert(rows.end(), {x, y, 0.14F * x + (roof ? 0.6F : 0.F)});
  }
  const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
  ASSERT_EQ(report.sensors.size(), 1U) << report.why;
  EXPECT_EQ(report.sensors[0].kind, SensorKind::ABOVE);
}

// From afar a wrong place may explain a view's densities well, too, from behind the surface.
TEST(Sensors, SuggestionGivesWayToTheBestPlace) {
  struct View {
    double heading;
    Vector by;
  };
  const Vector eye{1.0, 2.2, 1.4};
  for (const View& view : {View{0.2, {2.3, 2.7, -6.7}}, View{-0.3, {1.8, -7.1, -6.3}},
                           View{0.2, {-0.2, 1.4, 2.3}}, View{-0.3, {-14.0, 2.0, 1.0}}}) {
    Scan scan = viewFrom(eye, view.heading);
    scan.move(view.by);
    SensorOptions options;
    options.suggestions = {{0.F, 0.F, 0.F}};
    const SensorReport report = findSensors(scan.view(), options);
    ASSERT_EQ(report.sensors.size(), 1U) << report.why;
    EXPECT_FALSE(report.sensors[0].suggested);
    Vector truth = eye;
    for (std::size_t a = 0; a < 3; ++a) truth[a] += view.by[a];
    EXPECT_LT(distanceTo(report.sensors[0], truth), 0.2);
  }
}

}  // namespace
}  // namespace segorient
