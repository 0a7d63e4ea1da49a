// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Several stations, a scanner on its way, aircraft.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <type_traits>
#include <vector>

#include "sensor_scans.h"

namespace segorient {
namespace {

double distanceToNearest(const SensorReport& report, const Vector& truth) {
  double nearest = 1e30;
  for (const FoundSensor& s : report.sensors) nearest = std::min(nearest, distanceTo(s, truth));
  return nearest;
}

// Each point counts for the sensor that it has; of few beside edges there is no telling.
void expectNearlyAllShared(const SensorReport& report) {
  std::size_t points = 0;
  for (const FoundSensor& s : report.sensors) points += s.points;
  const std::vector<std::int32_t>& of = report.sensor_of;
  const auto with = std::count_if(of.begin(), of.end(), [](std::int32_t s) { return s >= 0; });
  EXPECT_EQ(points, static_cast<std::size_t>(with));
  EXPECT_GE(static_cast<double>(points), 0.999 * static_cast<double>(of.size()));
}

class SeveralStations : public testing::TestWithParam<double> {};

// Also where no wall runs along an axis.
TEST_P(SeveralStations, AreFoundAndShareThePoints) {
  std::array<Vector, 3> truth{{{1.0, 3.2, 1.5}, {5.2, 3.0, 1.4}, {3.0, 0.8, 1.6}}};
  Scan scan;
  std::vector<std::size_t> seen_by;
  for (std::size_t s = 0; s < truth.size(); ++s) {
    Scan one = scanFrom(truth[s], 1.8);
    seen_by.insert(seen_by.end(), one.view().size, s);
    scan.rows().insert(scan.rows().end(), one.rows().begin(), one.rows().end());
  }
  const double cosine = std::cos(GetParam());
  const double sine = std::sin(GetParam());
  const auto turn = [&](auto* p) {
    using Real = std::decay_t<decltype(*p)>;
    const auto x = static_cast<double>(p[0]);
    const auto y = static_cast<double>(p[1]);
    p[0] = static_cast<Real>(cosine * x - sine * y);
    p[1] = static_cast<Real>(sine * x + cosine * y);
  };
  for (std::size_t i = 0; i < scan.view().size; ++i) turn(&scan.rows()[3 * i]);
  for (Vector& t : truth) turn(t.data());
  const SensorReport report = findSensors(scan.view());
  ASSERT_EQ(report.sensors.size(), truth.size());
  for (const Vector& t : truth) {
    EXPECT_LT(distanceToNearest(report, t), 0.1);
  }
  for (std::size_t s = 0; s < report.sensors.size(); ++s) {
    EXPECT_TRUE(report.sensors[s].sure);
    EXPECT_GE(report.sensors[0].points, report.sensors[s].points);
  }
  ASSERT_EQ(report.sensor_of.size(), scan.view().size);
  expectNearlyAllShared(report);
  // Walls were seen from one side only.
  ASSERT_EQ(report.either_side.size(), scan.view().size);
  const auto unsure = std::count(report.either_side.begin(), report.either_side.end(), 1);
  EXPECT_LT(static_cast<double>(unsure), 0.05 * static_cast<double>(scan.view().size));
}

INSTANTIATE_TEST_SUITE_P(Sensors, SeveralStations, testing::Values(0.0, 0.8));

// Four stations leave nearly even densities, which too many of them fit worse than none. None sees
// the floor below itself, but that below the others.
TEST(Sensors, FourStationsAreFoundThatSeeNothingBelowThem) {
  const Room room{{4.2, 3.9, 2.5}, {3.2, 0.0, 0.0}, {4.2, 0.8, 1.5}};
  const std::array<Vector, 4> truth{
      {{1.1, 1.0, 1.2}, {2.9, 0.9, 1.4}, {1.0, 3.0, 1.5}, {3.2, 2.9, 1.6}}};
  Scan scan;
  for (const Vector& t : truth) {
    Scan one = scanFrom(t, 1.2, room, -0.8);
    scan.rows().insert(scan.rows().end(), one.rows().begin(), one.rows().end());
  }
  scan.blur(0.01F);
  const SensorReport report = findSensors(scan.view());
  ASSERT_EQ(report.sensors.size(), truth.size()) << report.why;
  for (const Vector& t : truth) {
    EXPECT_LT(distanceToNearest(report, t), 0.1);
  }
}

// A lidar of few beams that turns while it goes along, in a room and between two long walls, where
// most straight lines leave the scene; the last one stops three times only.
struct Way {
  Room room;
  std::size_t poses;
  Vector first;
  Vector step;
};

class MovingScanner : public testing::TestWithParam<Way> {};

TEST_P(MovingScanner, IsFoundAlongItsWay) {
  const Way& way = GetParam();
  std::vector<Vector> poses(way.poses, way.first);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) poses[i][a] += static_cast<double>(i) * way.step[a];
  }
  Scan scan = scanAlong(poses, way.room);
  const SensorReport report = findSensors(scan.view());
  ASSERT_GT(report.sensors.size(), 1U) << report.why;
  for (const FoundSensor& s : report.sensors) {
    EXPECT_TRUE(s.sure);
    double nearest = 1e30;
    for (const Vector& pose : poses) nearest = std::min(nearest, distanceTo(s, pose));
    // Between two poses, and .1 of the room's height.
    EXPECT_LT(nearest, 0.5 * way.step[0] + 0.1 * way.room.size[2]);
  }
  ASSERT_EQ(report.sensor_of.size(), scan.view().size);
  expectNearlyAllShared(report);
}

INSTANTIATE_TEST_SUITE_P(
    Sensors, MovingScanner,
    testing::Values(Way{{}, 12, {1.0, 1.6, 1.3}, {0.3, 0.04, 0.0}},
                    Way{{{50.0, 6.0, 5.0}, {30.0, 0.0, 0.0}, {34.0, 2.0, 2.0}},
                        12,
                        {6.0, 2.7, 1.8},
                        {1.2, 0.03, 0.0}},
                    Way{{{40.0, 14.0, 5.0}, {16.0, 0.0, 0.0}, {20.0, 2.0, 2.0}},
                        3,
                        {10.0, 6.3, 1.8},
                        {1.2, 0.1, 0.0}}));

// What somebody says of all points gives way to densities that tell the station for sure.
TEST(Sensors, AWrongPlaceForAllPointsIsReportedAndDoesNoHarm) {
  const Vector truth{2.0, 1.6, 1.5};
  Scan scan = scanFrom(truth, 1.8);
  const std::array<float, 3> wrong{9.F, 6.F, 5.F};
  for (const bool own : {false, true}) {
    auto hints = std::make_shared<OrientationHints>();
    hints->has_viewpoint = !own;
    hints->viewpoint = wrong;
    for (std::size_t i = 0; own && i < scan.view().size; ++i) {
      hints->viewpoints.insert(hints->viewpoints.end(), wrong.begin(), wrong.end());
    }
    PipelineOptions options;
    options.orientation.hints = hints;
    const OrientedCloud cloud = orientCloud(scan.view(), nullptr, options);
    ASSERT_FALSE(cloud.report.known_sensors.empty());
    EXPECT_FALSE(cloud.report.known_sensors[0].used);
    std::size_t facing = 0;
    for (std::size_t i = 0; i < scan.view().size; ++i) {
      double sum = 0.0;
      for (std::size_t a = 0; a < 3; ++a) {
        sum += static_cast<double>(cloud.normals[4 * i + a]) *
               (truth[a] - static_cast<double>(scan.view()[i][a]));
      }
      facing += sum > 0.0 ? 1U : 0U;
    }
    EXPECT_EQ(facing, scan.view().size);
  }
}

// Scanners that tilt turn about a level axis, along x here.
TEST(Sensors, TiltingScannersAreFoundOfWhichTheAxisLiesLevel) {
  const std::array<Vector, 3> truth{{{0.5, 3.4, 0.5}, {0.7, 2.2, 0.4}, {0.4, 1.0, 0.6}}};
  Scan scan;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.02);
  constexpr double kStep = 1.2 * kPi / 180.0;
  for (const Vector& t : truth) {
    for (double e = -1.45; e < 1.45; e += kStep) {
      for (double a = 0.1 * kStep; a < 2.0 * kPi; a += kStep) {
        scan.add(t, {std::sin(e), std::cos(e) * std::cos(a), std::cos(e) * std::sin(a)});
      }
    }
  }
  for (float& v : scan.rows()) v += static_cast<float>(noise(random));
  const SensorReport report = findSensors(scan.view());
  ASSERT_FALSE(report.sensors.empty()) << report.why;
  for (const FoundSensor& s : report.sensors) {
    double nearest = 1e30;
    for (const Vector& t : truth) nearest = std::min(nearest, distanceTo(s, t));
    EXPECT_LT(nearest, 0.39);  // a twentieth of the room's diagonal
    EXPECT_GT(std::fabs(s.axis[0]), 0.9F);
  }
}

// Hills 10 x 10 whose points are in strips more than twice as dense as what is between, as aircraft
// fly; with a thickness, another such sheet below.
std::vector<float> hills(std::size_t count, float thickness) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  while (rows.size() < 3 * count) {
    const float x = 10.F * unit(random);
    const float y = 10.F * unit(random);
    if (std::fmod(x, 2.F) > 0.5F && unit(random) > 0.4F) continue;
    const float below = rows.size() % 2 == 0 ? 0.F : thickness;
    rows.insert(rows.end(), {x, y, 0.5F * std::sin(x) * std::cos(0.8F * y) - below});
  }
  return rows;
}

TEST(Sensors, UnevenGroundIsSeenFromAbove) {
  const std::vector<float> rows = hills(30000, 0.F);
  const PointView points{rows.data(), 3, rows.size() / 3};
  const SensorReport report = findSensors(points);
  ASSERT_EQ(report.sensors.size(), 1U) << report.why;
  EXPECT_EQ(report.sensors[0].kind, SensorKind::ABOVE);
  EXPECT_EQ(report.sensors[0].axis, (std::array<float, 3>{0.F, 0.F, 1.F}));
  EXPECT_EQ(report.sensors[0].points, points.size);
  const OrientedCloud cloud = orientCloud(points, nullptr, {});
  std::size_t up = 0;
  for (std::size_t i = 0; i < points.size; ++i) up += cloud.normals[4 * i + 2] > 0.F ? 1 : 0;
  EXPECT_GT(static_cast<double>(up), 0.99 * static_cast<double>(points.size));
}

// Roofs of a town, .7 wide and .9 high, whose edges stand in a third of the columns.
TEST(Sensors, RoofsAreSeenFromAboveAsTheGroundIs) {
  std::vector<float> rows = hills(30000, 0.F);
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    const bool roof = std::fmod(rows[i], 1.25F) < 0.7F && std::fmod(rows[i + 1], 1.25F) < 0.7F;
    if (roof) rows[i + 2] += 0.9F;
  }
  const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
  ASSERT_EQ(report.sensors.size(), 1U) << report.why;
  EXPECT_EQ(report.sensors[0].kind, SensorKind::ABOVE);
}

// A pit in level ground, 2 deep and 8 wide at its bottom.
double pit(double x, double y) {
  return std::clamp(0.8 * (std::hypot(x, y) - 6.5), -2.0, 0.0);
}

// What a ray from `from` hits of the pit within 15 of its middle.
void addHit(const Vector& from, const Vector& direction, std::vector<float>& rows) {
  constexpr double kStride = 0.05;
  const auto at = [&](double t, std::size_t a) { return from[a] + t * direction[a]; };
  const auto above = [&](double t) { return at(t, 2) - pit(at(t, 0), at(t, 1)); };
  for (double t = kStride; std::hypot(at(t, 0), at(t, 1)) < 15.0; t += kStride) {
    if (above(t) > 0.0) continue;
    const double before = above(t - kStride);
    t -= kStride * above(t) / (above(t) - before);
    for (std::size_t a = 0; a < 3; ++a) rows.push_back(static_cast<float>(at(t, a)));
    return;
  }
}

// Of level ground, places above it and their images below explain the densities alike; the slopes
// of a pit tell them apart.
TEST(Sensors, StationsOnTheGroundAreNotTheirImagesBelowIt) {
  const std::array<Vector, 4> truth{
      {{9.0, 1.0, 1.6}, {-1.5, 8.5, 1.7}, {-9.2, -0.5, 1.5}, {0.5, -9.5, 1.8}}};
  std::vector<float> rows;
  constexpr double kStep = 1.1 * kPi / 180.0;
  for (const Vector& t : truth) {
    for (double e = -1.0; e < 0.0; e += kStep) {
      for (double a = 0.3 * kStep; a < 2.0 * kPi; a += kStep) {
        addHit(t, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}, rows);
      }
    }
  }
  const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
  ASSERT_EQ(report.sensors.size(), truth.size()) << report.why;
  for (const FoundSensor& s : report.sensors) {
    double nearest = 1e30;
    for (const Vector& t : truth) nearest = std::min(nearest, distanceTo(s, t));
    EXPECT_LT(nearest, 0.5);
  }
}

// Two strips of equal steps along the way and of angle across it. Densities of stations far above
// and far below explain them.
TEST(Sensors, StripsOfAnAircraftAreNotSeenFromFarBelow) {
  constexpr double kAltitude = 90.0;
  constexpr double kStep = 0.8;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.05);
  std::vector<float> rows;
  for (const double y0 : {-20.0, 20.0}) {
    for (double x = -60.0; x < 60.0; x += kStep) {
      for (double a = -0.436; a < 0.436; a += kStep / kAltitude) {
        const double z = 4.0 * std::sin(x / 8.0) * std::cos(0.1 * (y0 + kAltitude * std::tan(a)));
        for (const double v : {x, y0 + (kAltitude - z) * std::tan(a), z}) {
          rows.push_back(static_cast<float>(v + noise(random)));
        }
      }
    }
  }
  const PointView points{rows.data(), 3, rows.size() / 3};
  for (const FoundSensor& s : findSensors(points).sensors) EXPECT_GT(s.position[2], 0.F);
  const OrientedCloud cloud = orientCloud(points, nullptr, {});
  std::size_t up = 0;
  for (std::size_t i = 0; i < points.size; ++i) up += cloud.normals[4 * i + 2] > 0.F ? 1 : 0;
  const auto least = static_cast<double>(std::min(up, points.size - up));
  EXPECT_LT(least, 0.01 * static_cast<double>(points.size));
}

TEST(Sensors, PlatesAreNotSeenFromAbove) {
  for (const float thickness : {0.1F, 0.2F, 0.4F, 1.F, 2.F}) {
    const std::vector<float> rows = hills(30000, thickness);
    const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
    EXPECT_TRUE(report.sensors.empty()) << thickness;
  }
}

// Where a ray from within an egg-shaped cave ends.
double endInCave(const Vector& o, const Vector& d) {
  constexpr Vector kHalf{3.0, 2.0, 1.5};
  double dd = 0.0;
  double od = 0.0;
  double oo = -1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    dd += d[a] * d[a] / (kHalf[a] * kHalf[a]);
    od += o[a] * d[a] / (kHalf[a] * kHalf[a]);
    oo += o[a] * o[a] / (kHalf[a] * kHalf[a]);
  }
  return (std::sqrt(od * od - dd * oo) - od) / dd;
}

// Nothing in it hides anything, as in a body, and two scanners see what is below the other.
TEST(Caves, SeveralStationsInThemAreFound) {
  const std::array<Vector, 2> truth{{{1.5, 0.3, -0.4}, {-1.2, -0.5, 0.2}}};
  constexpr double kStep = 1.8 * kPi / 180.0;
  std::vector<float> xyz;
  for (const Vector& o : truth) {
    for (double e = -1.1; e < 1.5; e += kStep) {
      for (double a = 0.0; a < 2.0 * kPi; a += kStep) {
        const Vector d{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
        const double t = endInCave(o, d);
        for (std::size_t k = 0; k < 3; ++k) xyz.push_back(static_cast<float>(o[k] + t * d[k]));
      }
    }
  }
  const SensorReport report = findSensors({xyz.data(), 3, xyz.size() / 3});
  ASSERT_TRUE(report.sure()) << report.why;
  for (const Vector& t : truth) EXPECT_LT(distanceToNearest(report, t), 0.1);
}

}  // namespace
}  // namespace segorient
