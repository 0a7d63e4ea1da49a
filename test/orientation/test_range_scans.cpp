// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Objects of a few faces that a range scanner saw from one side, line by line: densities hardly
// vary, and the nearest points are of one line.
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

#include "sensor_scans.h"

namespace segorient {
namespace {

struct Hit {
  double distance = 1e30;
  Vector normal{0.0, 0.0, 0.0};
};

// A box from -1 to 1 with a smaller one upon it, seen from outside.
Hit firstHit(const Vector& o, const Vector& d) {
  constexpr std::array<std::array<Vector, 2>, 2> kBoxes{
      {{{{-1.0, -0.8, -0.6}, {1.0, 0.8, 0.2}}}, {{{-0.5, -0.5, 0.2}, {0.4, 0.3, 0.9}}}}};
  Hit out;
  for (const auto& [low, high] : kBoxes) {
    double enter = 0.0;
    double leave = 1e30;
    Vector normal{0.0, 0.0, 0.0};
    for (std::size_t a = 0; a < 3; ++a) {
      const double s = (low[a] - o[a]) / d[a];
      const double t = (high[a] - o[a]) / d[a];
      if (std::min(s, t) > enter) {
        enter = std::min(s, t);
        normal = {0.0, 0.0, 0.0};
        normal[a] = d[a] > 0.0 ? -1.0 : 1.0;
      }
      leave = std::min(leave, std::max(s, t));
    }
    if (enter < leave && enter > 0.0 && enter < out.distance) out = {enter, normal};
  }
  return out;
}

struct RangeScan {
  std::vector<float> rows;
  std::vector<Vector> normals;
  Vector eye;

  PointView view() const { return {rows.data(), 3, rows.size() / 3}; }
};

// \param distance of the scanner from the middle
// \param lines distance between them, in distances between their points
// \param noise along the rays, the same
RangeScan scanObject(const Vector& toward, double distance, double lines = 4.0,
                     double noise = 0.4) {
  constexpr double kStep = 0.011;
  RangeScan out;
  const double length =
      std::sqrt(toward[0] * toward[0] + toward[1] * toward[1] + toward[2] * toward[2]);
  Vector back{};
  for (std::size_t a = 0; a < 3; ++a) {
    back[a] = toward[a] / length;
    out.eye[a] = distance * back[a];
  }
  const double across = std::hypot(back[0], back[1]);
  const Vector right{-back[1] / across, back[0] / across, 0.0};
  const Vector up{-right[1] * back[2], right[0] * back[2], across};
  std::mt19937 random(7);
  std::normal_distribution<double> error(0.0, noise * kStep);
  for (double v = -1.6; v < 1.6; v += lines * kStep) {
    for (double u = -1.6; u < 1.6; u += kStep) {
      Vector d{};
      double square = 0.0;
      for (std::size_t a = 0; a < 3; ++a) {
        d[a] = (u * right[a] + v * up[a]) / distance - back[a];
        square += d[a] * d[a];
      }
      for (double& c : d) c /= std::sqrt(square);
      const Hit hit = firstHit(out.eye, d);
      if (hit.distance > 1e29) continue;
      const double range = hit.distance + error(random);
      for (std::size_t a = 0; a < 3; ++a) {
        out.rows.push_back(static_cast<float>(out.eye[a] + range * d[a]));
      }
      out.normals.push_back(hit.normal);
    }
  }
  return out;
}

double cosineAt(const RangeScan& scan, const OrientedCloud& cloud, std::size_t i) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    sum += scan.normals[i][a] * static_cast<double>(cloud.normals[4 * i + a]);
  }
  return sum;
}

double shareRight(const RangeScan& scan, const OrientedCloud& cloud) {
  std::size_t right = 0;
  for (std::size_t i = 0; i < scan.normals.size(); ++i) {
    right += cosineAt(scan, cloud, i) > 0.0 ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(scan.normals.size());
}

PipelineOptions seenFrom(const Vector& place) {
  auto hints = std::make_shared<OrientationHints>();
  hints->has_viewpoint = true;
  for (std::size_t a = 0; a < 3; ++a) hints->viewpoint[a] = static_cast<float>(place[a]);
  PipelineOptions options;
  options.orientation.hints = hints;
  return options;
}

class FromOneSide : public testing::TestWithParam<Vector> {};

// What is seen from below would face up otherwise.
TEST_P(FromOneSide, ItFacesTheScannerThatIsFound) {
  const RangeScan scan = scanObject(GetParam(), 6.0);
  const SensorReport report = findSensors(scan.view());
  ASSERT_TRUE(report.sure()) << report.why;
  double along = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    along += scan.eye[a] * static_cast<double>(report.sensors[0].position[a]);
  }
  EXPECT_GT(along, 0.0);
  EXPECT_GE(shareRight(scan, orientCloud(scan.view(), nullptr, {})), 0.99);
}

// Three faces that are seen alike, or hardly more than one: densities are all but even.
INSTANTIATE_TEST_SUITE_P(RangeScans, FromOneSide,
                         testing::Values(Vector{-0.6, -0.6, -0.6}, Vector{0.1, -0.1, -0.98},
                                         Vector{-0.05, 0.99, -0.1}));

class FromTheFront : public testing::TestWithParam<Vector> {};

// Planes of the nearest, which are of one line, turn with the noise along the rays.
TEST_P(FromTheFront, NormalsAreNotThoseOfSingleLines) {
  const RangeScan scan = scanObject(GetParam(), 6.0, 5.0, 0.3);
  const OrientedCloud cloud = orientCloud(scan.view(), nullptr, seenFrom(scan.eye));
  std::vector<double> cosines;
  for (std::size_t i = 0; i < scan.normals.size(); ++i) {
    cosines.push_back(cosineAt(scan, cloud, i));
  }
  // Three of four points are away from edges.
  const auto quarter = cosines.begin() + static_cast<std::ptrdiff_t>(cosines.size() / 4);
  std::nth_element(cosines.begin(), quarter, cosines.end());
  EXPECT_GT(*quarter, std::cos(6.0 * kPi / 180.0));
}

INSTANTIATE_TEST_SUITE_P(RangeScans, FromTheFront,
                         testing::Values(Vector{0.1, -0.1, -0.98}, Vector{-0.05, 0.99, -0.1}));

// Rays that are parallel tell the axis that they lie along, not the side.
TEST(RangeScans, ParallelRaysLeaveTheSideToWhoeverKnowsIt) {
  const RangeScan scan = scanObject({0.6, -0.7, -0.4}, 1e5);
  EXPECT_FALSE(findSensors(scan.view()).sure());
  Vector place = scan.eye;
  for (double& v : place) v *= 2e-4;
  const OrientedCloud cloud = orientCloud(scan.view(), nullptr, seenFrom(place));
  EXPECT_GE(shareRight(scan, cloud), 0.99);
  ASSERT_EQ(cloud.report.known_sensors.size(), 1U);
  EXPECT_TRUE(cloud.report.known_sensors[0].used);
}

// The axis of a rod explains the density of its vertices by rings as well as a way does that of a
// scene along it.
TEST(RangeScans, VerticesOfARodAreNotSeenFromItsAxis) {
  constexpr int kAround = 500;
  constexpr int kRings = 30;
  constexpr int kCircles = 24;
  std::vector<float> xyz;
  const auto ring = [&](double radius, double z) {
    for (int i = 0; i < kAround; ++i) {
      const double a = 2.0 * kPi * i / kAround;
      for (const double v : {radius * std::cos(a), radius * std::sin(a), z}) {
        xyz.push_back(static_cast<float>(v));
      }
    }
  };
  for (int i = 0; i < kRings; ++i) ring(1.0, std::pow(i / (kRings - 1.0), 2.0));
  for (int i = 0; i <= kCircles; ++i) {
    for (const double z : {0.0, 1.0}) ring(0.05 + 0.93 * i / kCircles, z);
  }
  const SensorReport report = findSensors({xyz.data(), 3, xyz.size() / 3});
  EXPECT_FALSE(report.sure()) << report.why;
}

}  // namespace
}  // namespace segorient
