// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Sensors that are found, against virtual ones in a box with exact rays.
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "sensor_scans.h"

namespace segorient {
namespace {

TEST(Sensors, StationIsFoundWithoutAnyHint) {
  const Vector truth{2.0, 2.5, 1.2};
  const SensorReport report = findSensors(scanFrom(truth, 2.0).view());
  ASSERT_EQ(report.sensors.size(), 1U);
  const FoundSensor& sensor = report.sensors[0];
  EXPECT_TRUE(sensor.sure);
  EXPECT_EQ(sensor.kind, SensorKind::STATION);
  EXPECT_FALSE(sensor.suggested);
  EXPECT_LT(sensor.cost_ratio, 0.2F);
  EXPECT_LT(distanceTo(sensor, truth), 0.05);
  EXPECT_GT(std::fabs(sensor.axis[2]), 0.99F);
  EXPECT_EQ(sensor.points, scanFrom(truth, 2.0).view().size);
}

TEST(Sensors, OriginIsTakenWhereItFits) {
  const Vector truth{2.0, 2.5, 1.2};
  Scan scan = scanFrom(truth, 2.0);
  scan.move({-truth[0], -truth[1], -truth[2]});
  const SensorReport report = findSensors(scan.view());
  ASSERT_EQ(report.sensors.size(), 1U);
  EXPECT_TRUE(report.sensors[0].suggested);
  EXPECT_EQ(report.sensors[0].position, (std::array<float, 3>{0.F, 0.F, 0.F}));
}

TEST(Sensors, SuggestionThatDoesNotFitIsNoEvidence) {
  const Vector truth{2.0, 2.5, 1.2};
  SensorOptions options;
  options.search = false;
  options.suggestions = {{5.F, 0.5F, 2.5F}};
  EXPECT_TRUE(findSensors(scanFrom(truth, 2.0).view(), options).sensors.empty());
  options.suggestions.push_back({2.F, 2.5F, 1.2F});
  options.suggestions.push_back({std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F});
  const SensorReport report = findSensors(scanFrom(truth, 2.0).view(), options);
  ASSERT_EQ(report.sensors.size(), 1U);
  EXPECT_LT(distanceTo(report.sensors[0], truth), 1e-6);
}

TEST(Sensors, CameraIsFoundByDensityAndByItsImage) {
  const Vector eye{0.7, 2.0, 1.4};
  const Scan scan = viewFrom(eye, 0.2);
  const SensorReport by_density = findSensors(scan.view());
  ASSERT_EQ(by_density.sensors.size(), 1U);
  EXPECT_EQ(by_density.sensors[0].kind, SensorKind::CAMERA);
  EXPECT_LT(distanceTo(by_density.sensors[0], eye), 0.3);  // 5 % of the scene
  SensorOptions options;
  options.image_width = kWidth;
  const SensorReport by_image = findSensors(scan.view(), options);
  ASSERT_EQ(by_image.sensors.size(), 1U);
  const FoundSensor& sensor = by_image.sensors[0];
  EXPECT_EQ(sensor.evidence, SensorEvidence::IMAGE);
  EXPECT_LT(distanceTo(sensor, eye), 1e-3);
  EXPECT_NEAR(sensor.axis[0], std::cos(0.2), 1e-3);
  EXPECT_NEAR(sensor.axis[1], std::sin(0.2), 1e-3);
  EXPECT_EQ(by_image.sensor_of[7], -1);  // a pixel that saw nothing
  EXPECT_EQ(by_image.sensor_of[8], 0);
}

TEST(Sensors, OrganisedCloudIsAnImage) {
  const Vector eye{0.7, 2.0, 1.4};
  const Scan scan = viewFrom(eye, 0.2);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (std::size_t i = 0; i < scan.view().size; ++i) {
    const float* p = scan.view()[i];
    cloud.push_back({p[0], p[1], p[2]});
  }
  cloud.width = kWidth;
  cloud.height = kHeight;
  const SensorReport report = findSensors(cloud);
  ASSERT_EQ(report.sensors.size(), 1U);
  EXPECT_EQ(report.sensors[0].evidence, SensorEvidence::IMAGE);
}

TEST(Sensors, OrganisedScanOfAnglesIsNoImage) {
  const Vector truth{2.0, 2.5, 1.2};
  const Scan scan = scanFrom(truth, 2.0);
  SensorOptions options;
  options.image_width = 180;
  const SensorReport report = findSensors(scan.view(), options);
  ASSERT_EQ(report.sensors.size(), 1U);
  EXPECT_EQ(report.sensors[0].evidence, SensorEvidence::DENSITY);
  EXPECT_LT(distanceTo(report.sensors[0], truth), 0.05);
}

TEST(Sensors, EvenSamplingHasNone) {
  std::vector<float> rows = evenBox(12000);
  EXPECT_TRUE(findSensors({rows.data(), 3, rows.size() / 3}).sensors.empty());
  for (float& v : rows) v -= 0.5F;  // the origin inside
  const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
  EXPECT_TRUE(report.sensors.empty());
  EXPECT_FALSE(report.why.empty());
  EXPECT_EQ(report.sensor_of, std::vector<std::int32_t>(rows.size() / 3, -1));
}

TEST(Sensors, UnevenSamplingAloneIsNoSensor) {
  std::vector<float> all = evenBox(40000);
  std::vector<float> rows;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  for (std::size_t i = 0; i < all.size(); i += 3) {
    // Ten times as dense at one end as at the other.
    if (unit(random) > std::pow(0.1F, all[i])) continue;
    rows.insert(rows.end(), {all[i], all[i + 1], all[i + 2]});
  }
  EXPECT_TRUE(findSensors({rows.data(), 3, rows.size() / 3}).sensors.empty());
}

TEST(Sensors, UnitsOrderThreadsAndDuplicatesDoNotMatter) {
  const Vector truth{2.0, 2.5, 1.2};
  Scan scan = scanFrom(truth, 2.0);
  SensorOptions options;
  options.threads = 1;
  const SensorReport first = findSensors(scan.view(), options);
  ASSERT_EQ(first.sensors.size(), 1U);
  std::vector<std::array<float, 3>> rows;
  for (std::size_t i = 0; i < scan.view().size; ++i) {
    const float* p = scan.view()[i];
    rows.push_back({p[0], p[1], p[2]});
  }
  std::mt19937 random(1);
  std::shuffle(rows.begin(), rows.end(), random);
  rows.push_back(rows[0]);
  rows.push_back({std::numeric_limits<float>::infinity(), 0.F, 0.F});
  options.threads = 3;
  const SensorReport second = findSensors({rows[0].data(), 3, rows.size()}, options);
  ASSERT_EQ(second.sensors.size(), 1U);
  EXPECT_EQ(first.sensors[0].position, second.sensors[0].position);
  EXPECT_EQ(first.sensors[0].cost_ratio, second.sensors[0].cost_ratio);
  EXPECT_EQ(second.sensors[0].points, rows.size() - 1);
  EXPECT_EQ(second.sensor_of.back(), -1);
  scan.scale(1024.F);
  const SensorReport third = findSensors(scan.view(), options);
  ASSERT_EQ(third.sensors.size(), 1U);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(third.sensors[0].position[a], 1024.F * first.sensors[0].position[a]);
  }
}

TEST(Sensors, BadInputHasNone) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(findSensors(PointView{}).sensors.empty());
  const std::vector<float> nothing(3 * 5000, kNaN);
  EXPECT_TRUE(findSensors({nothing.data(), 3, 5000}).sensors.empty());
  const std::vector<float> same(3 * 5000, 1.F);
  EXPECT_TRUE(findSensors({same.data(), 3, 5000}).sensors.empty());
  std::vector<float> line;
  for (int i = 0; i < 5000; ++i) line.insert(line.end(), {static_cast<float>(i), 0.F, 0.F});
  SensorOptions options;
  options.image_width = 50;
  EXPECT_TRUE(findSensors({line.data(), 3, 5000}, options).sensors.empty());
  options.image_width = 5001;  // no whole row
  EXPECT_TRUE(findSensors({line.data(), 3, 5000}, options).sensors.empty());
  std::vector<float> huge = evenBox(5000);
  for (float& v : huge) v *= 1e37F;
  EXPECT_TRUE(findSensors({huge.data(), 3, 5000}).sensors.empty());
}

// Share of the normals that face the station.
double facing(const OrientedCloud& cloud, const PointView& points, const Vector& station) {
  std::size_t right = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    double dot = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      dot += static_cast<double>(cloud.normals[4 * i + a]) *
             (station[a] - static_cast<double>(points[i][a]));
    }
    right += dot > 0.0 ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(points.size);
}

// Below a floor there is a place of which densities say the same.
TEST(Sensors, AFloorWasSeenFromAbove) {
  for (const double height : {1.0, 1.5, 2.5}) {
    std::mt19937 random(31);
    std::uniform_real_distribution<double> turn(0.0, 6.28318530718);
    std::uniform_real_distribution<double> cosine(0.2, 1.0);
    std::vector<float> xyz;
    for (int i = 0; i < 12000; ++i) {
      const double z = cosine(random);
      const double reach = height * std::sqrt(1.0 - z * z) / z;
      const double phi = turn(random);
      xyz.insert(xyz.end(), {static_cast<float>(40.0 + reach * std::cos(phi)),
                             static_cast<float>(-30.0 + reach * std::sin(phi)), 5.F});
    }
    const SensorReport report = findSensors({xyz.data(), 3, xyz.size() / 3});
    ASSERT_EQ(report.sensors.size(), 1U) << report.why;
    EXPECT_LT(distanceTo(report.sensors[0], {40.0, -30.0, 5.0 + height}), 0.1 * height);
  }
}

TEST(Sensors, NormalsOfARoomFaceTheStationThatWasFound) {
  const Vector truth{2.0, 2.5, 1.2};
  const Scan scan = scanFrom(truth, 2.5);
  PipelineOptions options;
  const OrientedCloud found = orientCloud(scan.view(), nullptr, options);
  ASSERT_EQ(found.report.sensors.sensors.size(), 1U);
  EXPECT_GT(facing(found, scan.view(), truth), 0.97);
  options.orientation.automatic.find_sensors = false;
  const OrientedCloud alone = orientCloud(scan.view(), nullptr, options);
  EXPECT_TRUE(alone.report.sensors.sensors.empty());
  EXPECT_LT(facing(alone, scan.view(), truth), 0.03);  // a closed room: outward
}

TEST(Sensors, WhatIsKnownIsNotSought) {
  const Vector truth{2.0, 2.5, 1.2};
  const Scan scan = scanFrom(truth, 2.5);
  PipelineOptions options;
  auto hints = std::make_shared<OrientationHints>();
  hints->surface = SurfaceKind::CLOSED;
  options.orientation.hints = hints;
  EXPECT_TRUE(orientCloud(scan.view(), nullptr, options).report.sensors.sensors.empty());
  hints = std::make_shared<OrientationHints>();
  hints->has_viewpoint = true;
  hints->viewpoint = {2.F, 2.5F, 1.2F};
  options.orientation.hints = hints;
  EXPECT_TRUE(orientCloud(scan.view(), nullptr, options).report.sensors.sensors.empty());
}

}  // namespace
}  // namespace segorient
