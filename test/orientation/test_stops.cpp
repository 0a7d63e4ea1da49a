// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Lidars in streets that stopped a few times: several stations elsewhere explain as much as is
// asked of them.
#include <gtest/gtest.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "scanned_boxes.h"
#include "sensor_scans.h"

namespace segorient::test {
namespace {

struct Street {
  std::vector<Box> boxes;  // the ground, houses, cars
  Vector first;
};

// 32 beams from 25 degrees below to 15 above the horizon, at three stops.
std::vector<float> seenAtStops(const Street& street, const std::vector<Vector>& stops) {
  constexpr int kBeams = 32;
  constexpr int kAzimuths = 600;
  constexpr double kReach = 60.0;
  constexpr double kDegree = kPi / 180.0;
  std::vector<float> out;
  for (std::size_t s = 0; s < stops.size(); ++s) {
    for (int b = 0; b < kBeams; ++b) {
      const double elevation = kDegree * (-25.0 + 40.0 * b / (kBeams - 1));
      for (int z = 0; z < kAzimuths; ++z) {
        const double azimuth = kDegree * (0.05 + 0.1 * static_cast<double>(s) + 0.6 * z);
        const Vector ray{std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
        Vector normal{};
        const double t = hit(street.boxes, stops[s], ray, normal);
        if (!(t < kReach)) continue;
        for (std::size_t a = 0; a < 3; ++a) {
          out.push_back(static_cast<float>(stops[s][a] + t * ray[a]));
        }
      }
    }
  }
  return out;
}

class Stops : public testing::TestWithParam<Street> {};

TEST_P(Stops, AreALineRatherThanStationsElsewhere) {
  constexpr double kBetween = 1.2;
  std::vector<Vector> stops(3, GetParam().first);
  for (std::size_t s = 0; s < stops.size(); ++s) stops[s][0] += kBetween * static_cast<double>(s);
  const std::vector<float> xyz = seenAtStops(GetParam(), stops);
  const SensorReport report = findSensors({xyz.data(), 3, xyz.size() / 3});
  ASSERT_FALSE(report.sensors.empty()) << report.why;
  for (const FoundSensor& sensor : report.sensors) {
    EXPECT_TRUE(sensor.sure);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector& stop : stops) nearest = std::min(nearest, distanceTo(sensor, stop));
    EXPECT_LT(nearest, kBetween) << report.why;
  }
}

INSTANTIATE_TEST_SUITE_P(Sensors, Stops,
                         testing::Values(Street{{{{-5, -30, -1}, {65, 30, 0}},
                                                 {{-5, -13, 0}, {6, -7, 7}},
                                                 {{6, -14, 0}, {20, -8, 4}},
                                                 {{20, -14, 0}, {31, -8, 6}},
                                                 {{31, -15, 0}, {43, -9, 5}},
                                                 {{43, -14, 0}, {56, -8, 6}},
                                                 {{-5, 8, 0}, {5, 14, 7}},
                                                 {{5, 9, 0}, {19, 15, 5}},
                                                 {{19, 9, 0}, {31, 15, 4}},
                                                 {{35, 6, 0}, {48, 12, 7}},
                                                 {{48, 7, 0}, {57, 13, 6}},
                                                 {{57, 8, 0}, {67, 14, 4}},
                                                 {{35, 3, 0}, {39, 4.8, 1.5}},
                                                 {{18, 3, 0}, {22, 4.8, 1.5}},
                                                 {{2, -4, 0}, {6, -2.2, 1.5}},
                                                 {{36, 3, 0}, {40, 4.8, 1.5}},
                                                 {{4, -4, 0}, {8, -2.2, 1.5}}},
                                                {12.0, 0.1, 1.8}},
                                         Street{{{{-5, -30, -1}, {65, 30, 0}},
                                                 {{-5, -15, 0}, {8, -9, 8}},
                                                 {{12, -12, 0}, {25, -6, 5}},
                                                 {{32, -15, 0}, {42, -9, 4}},
                                                 {{42, -14, 0}, {57, -8, 8}},
                                                 {{-5, 7, 0}, {3, 13, 6}},
                                                 {{7, 8, 0}, {22, 14, 5}},
                                                 {{29, 7, 0}, {40, 13, 4}},
                                                 {{40, 8, 0}, {49, 14, 7}},
                                                 {{56, 9, 0}, {68, 15, 8}},
                                                 {{38, 3, 0}, {42, 4.8, 1.5}},
                                                 {{7, -4, 0}, {11, -2.2, 1.5}},
                                                 {{13, 3, 0}, {17, 4.8, 1.5}},
                                                 {{29, 3, 0}, {33, 4.8, 1.5}},
                                                 {{8, -4, 0}, {12, -2.2, 1.5}}},
                                                {18.0, 0.1, 1.8}}));

}  // namespace
}  // namespace segorient::test
