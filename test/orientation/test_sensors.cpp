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

namespace segorient {
namespace {

using Vector = std::array<double, 3>;

constexpr double kPi = 3.14159265358979323846;

// A room 6 x 4 x 3 with a cupboard, seen from inside.
struct Room {
  Vector size{6.0, 4.0, 3.0};
  Vector low{4.5, 0.0, 0.0};  // the cupboard
  Vector high{6.0, 1.0, 2.0};

  double firstHit(const Vector& o, const Vector& d) const {
    double leave = 1e30;
    double enter_box = 0.0;
    double leave_box = 1e30;
    for (std::size_t a = 0; a < 3; ++a) {
      if (std::fabs(d[a]) < 1e-12) {
        if (o[a] < low[a] || o[a] > high[a]) leave_box = -1.0;
        continue;
      }
      leave = std::min(leave, ((d[a] > 0 ? size[a] : 0.0) - o[a]) / d[a]);
      const double s = (low[a] - o[a]) / d[a];
      const double t = (high[a] - o[a]) / d[a];
      enter_box = std::max(enter_box, std::min(s, t));
      leave_box = std::min(leave_box, std::max(s, t));
    }
    return enter_box < leave_box && enter_box > 0.0 ? std::min(enter_box, leave) : leave;
  }
};

class Scan {
 public:
  void add(const Vector& o, const Vector& d) {
    const double t = room_.firstHit(o, d);
    for (std::size_t a = 0; a < 3; ++a) rows_.push_back(static_cast<float>(o[a] + t * d[a]));
  }
  void addNothing() { rows_.insert(rows_.end(), 3, std::numeric_limits<float>::quiet_NaN()); }
  void move(const Vector& by) {
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i] += static_cast<float>(by[i % 3]);
  }
  void scale(float by) {
    for (float& v : rows_) v *= by;
  }
  std::vector<float>& rows() { return rows_; }
  PointView view() const { return {rows_.data(), 3, rows_.size() / 3}; }

 private:
  Room room_;
  std::vector<float> rows_;
};

// A scanner on a tripod: equal steps of azimuth and elevation.
Scan scanFrom(const Vector& station, double step_degrees) {
  Scan scan;
  const double step = step_degrees * kPi / 180.0;
  for (double e = -1.0; e < 1.5; e += step) {
    for (double a = 0.1 * step; a < 2.0 * kPi; a += step) {
      scan.add(station, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)});
    }
  }
  return scan;
}

constexpr std::size_t kWidth = 120;
constexpr std::size_t kHeight = 90;

// A camera that looks along `forward` (level) from `eye`; every 50th pixel is missing.
Scan viewFrom(const Vector& eye, double heading) {
  Scan scan;
  const Vector forward{std::cos(heading), std::sin(heading), 0.0};
  const Vector right{std::sin(heading), -std::cos(heading), 0.0};
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    const double u = (static_cast<double>(i % kWidth) - 60.0) / 100.0;
    const double v = (static_cast<double>(i / kWidth) - 45.0) / 100.0;
    if (i % 50 == 7) {
      scan.addNothing();
    } else {
      scan.add(eye, {forward[0] + u * right[0], forward[1] + u * right[1], -v});
    }
  }
  return scan;
}

// A box sampled evenly, at random.
std::vector<float> evenBox(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 3> p{unit(random), unit(random), unit(random)};
    p[i % 3] = i % 2 == 0 ? 0.F : 1.F;
    rows.insert(rows.end(), p.begin(), p.end());
  }
  return rows;
}

double distanceTo(const FoundSensor& sensor, const Vector& truth) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    sum += std::pow(static_cast<double>(sensor.position[a]) - truth[a], 2);
  }
  return std::sqrt(sum);
}

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

TEST(Sensors, SeveralStationsAreFoundAndShareThePoints) {
  const std::array<Vector, 3> truth{{{1.0, 3.2, 1.5}, {5.2, 3.0, 1.4}, {3.0, 0.8, 1.6}}};
  Scan scan;
  std::vector<std::size_t> seen_by;
  for (std::size_t s = 0; s < truth.size(); ++s) {
    Scan one = scanFrom(truth[s], 1.8);
    seen_by.insert(seen_by.end(), one.view().size, s);
    scan.rows().insert(scan.rows().end(), one.rows().begin(), one.rows().end());
  }
  const SensorReport report = findSensors(scan.view());
  ASSERT_EQ(report.sensors.size(), truth.size());
  std::size_t points = 0;
  for (const Vector& t : truth) {
    double nearest = 1e30;
    for (const FoundSensor& s : report.sensors) nearest = std::min(nearest, distanceTo(s, t));
    EXPECT_LT(nearest, 0.1);
  }
  for (std::size_t s = 0; s < report.sensors.size(); ++s) {
    EXPECT_TRUE(report.sensors[s].sure);
    points += report.sensors[s].points;
    EXPECT_GE(report.sensors[0].points, report.sensors[s].points);
  }
  EXPECT_EQ(points, scan.view().size);
}

// A lidar of few beams that turns while it goes along.
TEST(Sensors, AMovingScannerIsFoundAlongItsWay) {
  Scan scan;
  constexpr int kPoses = 12;
  const auto pose = [](int i) { return Vector{1.0 + 0.3 * i, 1.6 + 0.04 * i, 1.3}; };
  for (int i = 0; i < kPoses; ++i) {
    for (double e = -25.0; e <= 15.0; e += 2.5) {
      for (double a = 0.1 * i; a < 360.0; a += 1.5) {
        const double azimuth = a * kPi / 180.0;
        const double elevation = e * kPi / 180.0;
        scan.add(pose(i), {std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation)});
      }
    }
  }
  const SensorReport report = findSensors(scan.view());
  ASSERT_GT(report.sensors.size(), 1U) << report.why;
  std::size_t points = 0;
  for (const FoundSensor& s : report.sensors) {
    EXPECT_TRUE(s.sure);
    double nearest = 1e30;
    for (int i = 0; i < kPoses; ++i) nearest = std::min(nearest, distanceTo(s, pose(i)));
    EXPECT_LT(nearest, 0.4);
    points += s.points;
  }
  EXPECT_EQ(points, scan.view().size);
}

// Hills 10 x 10 whose points are in strips ten times as dense as what is between, as aircraft fly;
// with a thickness, another such sheet below.
std::vector<float> hills(std::size_t count, float thickness) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  while (rows.size() < 3 * count) {
    const float x = 10.F * unit(random);
    const float y = 10.F * unit(random);
    if (std::fmod(x, 2.F) > 0.7F && unit(random) > 0.1F) continue;
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

TEST(Sensors, ThinPlatesAreNotSeenFromAbove) {
  for (const float thickness : {0.1F, 0.2F, 0.4F, 1.F}) {
    const std::vector<float> rows = hills(30000, thickness);
    const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
    EXPECT_TRUE(report.sensors.empty()) << thickness;
  }
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

TEST(Sensors, NormalsOfARoomFaceTheStationThatWasFound) {
  const Vector truth{2.0, 2.5, 1.2};
  const Scan scan = scanFrom(truth, 2.5);
  PipelineOptions options;
  const OrientedCloud found = orientCloud(scan.view(), nullptr, options);
  ASSERT_EQ(found.report.sensors.sensors.size(), 1U);
  EXPECT_GT(facing(found, scan.view(), truth), 0.97);
  options.automatic.find_sensors = false;
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
