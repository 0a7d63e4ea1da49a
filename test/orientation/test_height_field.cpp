// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// One surface over the ground, sampled evenly: no sensor shows, but its upper side is the seen one.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "orientation/sensors/height_field.h"
#include "orientation/sensors/known_sensors.h"
#include "search/index_of.h"

namespace segorient {
namespace {

// A village on hills, 10 x 10: houses of the height of two or three spacings, and points of bushes.
std::vector<float> village(std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::normal_distribution<float> noise(0.F, 0.02F);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = 10.F * unit(random);
    const float y = 10.F * unit(random);
    float z = 0.4F * std::sin(x) * std::cos(0.8F * y) + noise(random);
    if (std::fmod(x, 1.1F) < 0.5F && std::fmod(y, 1.3F) < 0.6F) z += 0.3F;
    if (std::fmod(x + 0.6F * y, 1.7F) < 0.3F) z += 0.35F * unit(random);
    rows.insert(rows.end(), {x, y, z});
  }
  return rows;
}

// Even sheets, a thickness apart.
std::vector<float> plate(std::size_t count, float thickness) {
  std::mt19937 random(12);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = 10.F * unit(random);
    const float y = 10.F * unit(random);
    rows.insert(rows.end(), {x, y, 0.4F * std::sin(x) - (i % 2 == 0 ? 0.F : thickness)});
  }
  return rows;
}

// Hills, 10 x 10, half of whose points are scattered from one height over them to another.
std::vector<float> woods(std::size_t count, float from, float to) {
  std::mt19937 random(14);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows = plate(count / 2, 0.F);
  while (rows.size() < 3 * count) {
    const float x = 10.F * unit(random);
    const float y = 10.F * unit(random);
    if (std::sin(3.F * x) + std::sin(2.F * y) < -0.5F) continue;
    rows.insert(rows.end(), {x, y, 0.4F * std::sin(x) + from + (to - from) * unit(random)});
  }
  return rows;
}

double shareUp(const std::vector<float>& rows, const std::shared_ptr<OrientationHints>& hints) {
  PipelineOptions options;
  options.orientation.hints = hints;
  const std::size_t n = rows.size() / 3;
  const OrientedCloud cloud = orientCloud({rows.data(), 3, n}, nullptr, options);
  std::size_t up = 0;
  for (std::size_t i = 0; i < n; ++i) up += cloud.normals[4 * i + 2] > 0.F ? 1 : 0;
  return static_cast<double>(up) / static_cast<double>(n);
}

TEST(HeightField, FacesUpThoughNoSensorIsClaimed) {
  const std::vector<float> rows = village(9000);
  const SensorReport report = findSensors({rows.data(), 3, rows.size() / 3});
  EXPECT_TRUE(report.sensors.empty());
  EXPECT_TRUE(report.faces_up) << report.why;
  EXPECT_GE(shareUp(rows, nullptr), 0.999);
}

// Ground of 10 x 10 with balls on it, whose undersides show down to where they touch it; evenly
// sampled. Rows, and their normals.
struct GroundWithBalls {
  std::vector<float> rows;
  std::vector<float> normals;

  GroundWithBalls() {
    std::mt19937 random(14);
    std::uniform_real_distribution<float> unit(-1.F, 1.F);
    std::normal_distribution<float> gauss;
    for (int i = 0; i < 20000; ++i) {
      const float x = 5.F * unit(random);
      const float y = 5.F * unit(random);
      if (std::hypot(std::fabs(x) - 2.F, y) > kTouches) add({x, y, 0.F}, {0.F, 0.F, 1.F});
    }
    for (const float x : {-2.F, 2.F}) {
      for (int i = 0; i < 1600; ++i) {
        Eigen::Vector3f out{gauss(random), gauss(random), gauss(random)};
        out.normalize();
        const Eigen::Vector3f at = kRadius * out + Eigen::Vector3f(x, 0.F, kHeight);
        if (at.z() > 0.F) add(at, out);
      }
    }
  }
  double shareRight(const std::vector<float>& found) const {
    std::size_t right = 0;
    for (std::size_t i = 0; 3 * i < rows.size(); ++i) {
      float cosine = 0.F;
      for (std::size_t a = 0; a < 3; ++a) cosine += normals[3 * i + a] * found[4 * i + a];
      right += cosine > 0.F ? 1 : 0;
    }
    return 3.0 * static_cast<double>(right) / static_cast<double>(rows.size());
  }

 private:
  static constexpr float kRadius = 0.8F;
  static constexpr float kHeight = 0.75F;    // of its middle
  static constexpr float kTouches = 0.278F;  // radius of the circle that it meets the ground in

  void add(const Eigen::Vector3f& at, const Eigen::Vector3f& out) {
    rows.insert(rows.end(), at.data(), at.data() + 3);
    normals.insert(normals.end(), out.data(), out.data() + 3);
  }
};

TEST(HeightField, UndersidesOfWhatStandsOnItFaceDown) {
  const GroundWithBalls scene;
  const PointView points{scene.rows.data(), 3, scene.rows.size() / 3};
  EXPECT_TRUE(findSensors(points).faces_up);
  EXPECT_GE(scene.shareRight(orientCloud(points, nullptr, {}).normals), 0.995);
}

TEST(HeightField, NothingIsAboveWhatIsOpenToTheSky) {
  const std::vector<float> one = plate(9000, 0.F);
  const std::vector<std::uint8_t> all =
      detail::openToTheSky({one.data(), 3, one.size() / 3}, 0.105F);
  EXPECT_EQ(std::count(all.begin(), all.end(), 1), 9000);
  const std::vector<float> two = plate(18000, 2.F);
  const std::vector<std::uint8_t> upper =
      detail::openToTheSky({two.data(), 3, two.size() / 3}, 0.105F);
  for (std::size_t i = 0; i < upper.size(); i += 2) ASSERT_EQ(upper[i], 1) << i;
  EXPECT_LE(std::count(upper.begin(), upper.end(), 1), 9000 + 450);
  EXPECT_EQ(detail::openToTheSky({one.data(), 3, 5}, 0.F), std::vector<std::uint8_t>(5, 1));
  EXPECT_TRUE(detail::openToTheSky({nullptr, 3, 0}, 1.F).empty());
}

TEST(HeightField, WhoeverNamesASideMeansIt) {
  const std::vector<float> rows = plate(9000, 0.F);
  const auto hints = std::make_shared<OrientationHints>();
  hints->seeds.push_back({{5.F, 5.F, 0.4F * std::sin(5.F)}, {0.F, 0.F, -1.F}});
  EXPECT_LE(shareUp(rows, hints), 0.01);
}

TEST(HeightField, PlatesAreNone) {
  for (const float thickness : {0.F, 0.1F, 0.2F, 0.4F, 1.F, 2.F}) {
    const std::vector<float> rows = plate(20000, thickness);
    const bool single = thickness == 0.F;
    EXPECT_EQ(findSensors({rows.data(), 3, rows.size() / 3}).faces_up, single) << thickness;
  }
}

// A rod has a layer below the upper one, but slopes away between them.
TEST(HeightField, WhatIsNarrowIsNone) {
  for (const std::size_t count : {3000, 6000}) {
    std::mt19937 random(13);
    std::uniform_real_distribution<float> unit(0.F, 1.F);
    std::vector<float> rows;
    for (std::size_t i = 0; i < count; ++i) {
      const float x = 10.F * unit(random);
      const float angle = 6.2831853F * unit(random);
      rows.insert(rows.end(), {x, std::sin(x) + 0.4F * std::cos(angle), 0.4F * std::sin(angle)});
    }
    const SensorReport report = findSensors({rows.data(), 3, count});
    EXPECT_TRUE(report.sensors.empty());
    EXPECT_FALSE(report.faces_up) << count;
  }
}

TEST(HeightField, WhatStandsUprightIsNone) {
  std::vector<float> rows = village(9000);
  for (std::size_t i = 0; i < rows.size(); i += 3) std::swap(rows[i], rows[i + 2]);
  EXPECT_FALSE(findSensors({rows.data(), 3, rows.size() / 3}).faces_up);
}

// A street as those see it who drive through: from above, walls would have few points.
TEST(HeightField, WhatIsBetweenWallsIsNone) {
  std::mt19937 random(13);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  for (std::size_t i = 0; i < 30000; ++i) {
    const float x = 40.F * unit(random);
    const float across = 26.F * unit(random) - 8.F;  // up a wall, over the ground, up the other one
    const float y = std::clamp(across, 0.F, 10.F);
    rows.insert(rows.end(), {x, y, std::fabs(across - y)});
  }
  EXPECT_FALSE(findSensors({rows.data(), 3, rows.size() / 3}).faces_up);
  std::vector<float> ground;
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    if (rows[i + 2] < 0.5F) ground.insert(ground.end(), &rows[i], &rows[i] + 3);
  }
  EXPECT_TRUE(findSensors({ground.data(), 3, ground.size() / 3}).faces_up);
}

// It closes as a body does, with the ground below.
TEST(HeightField, WoodsStandOnTheGround) {
  const std::vector<float> rows = woods(20000, 0.5F, 4.F);
  const PointView points{rows.data(), 3, rows.size() / 3};
  const SensorReport report = findSensors(points);
  ASSERT_TRUE(report.sure());
  EXPECT_EQ(report.sensors[0].kind, SensorKind::ABOVE);
  EXPECT_EQ(report.sensors[0].evidence, SensorEvidence::WOODS);
  EXPECT_STREQ(toString(SensorEvidence::WOODS), "woods");
  PipelineOptions options;
  for (const bool told : {false, true}) {
    const auto hints = std::make_shared<OrientationHints>();
    hints->has_viewpoint = told;
    hints->viewpoint = {5.F, 5.F, 1000.F};
    options.orientation.hints = hints;
    const OrientedCloud cloud = orientCloud(points, nullptr, options);
    std::size_t up = 0;
    for (std::size_t i = 0; i < points.size / 2; ++i) up += cloud.normals[4 * i + 2] > 0.F ? 1 : 0;
    EXPECT_EQ(up, points.size / 2) << told;
  }
}

// Nothing that is scattered hides the ground, but a surface above it does.
TEST(HeightField, WhoeverIsAboveWoodsIsBelieved) {
  for (const bool solid : {false, true}) {
    std::vector<float> rows = woods(20000, 0.5F, 4.F);
    if (solid) {
      const std::vector<float> top = plate(10000, 0.F);
      rows = top;
      for (std::size_t i = 0; i < top.size(); i += 3) {
        rows.insert(rows.end(), {top[i] + 0.01F, top[i + 1], top[i + 2] + 2.F});
      }
    }
    const PointView points{rows.data(), 3, rows.size() / 3};
    Neighborhoods table;
    search::indexOf(points, 0).nearestKAll(33, table, false);
    const std::vector<float> spacing(points.size, 0.1F);
    PointHints hints;
    for (std::size_t i = 0; i < points.size; ++i) {
      hints.sensors.insert(hints.sensors.end(), {5.F, 5.F, 1000.F});
    }
    const detail::KnownSensors known =
        detail::findKnownSensors(points, table, spacing.data(), hints, 0);
    ASSERT_EQ(known.scans.size(), 1U);
    EXPECT_EQ(known.scans[0].used, !solid);
    EXPECT_EQ(known.confirmed, !solid);
    EXPECT_EQ(known.scans[0].hidden > 0.F, solid);
  }
}

// From within, all that is before its surface is scattered, too.
TEST(HeightField, WhoeverIsInABodyFullOfPointsIsNot) {
  std::mt19937 random(15);
  std::normal_distribution<float> normal(0.F, 1.F);
  std::vector<float> rows;
  constexpr std::size_t kSurface = 10000;
  for (std::size_t i = 0; i < kSurface + 2000; ++i) {
    std::array<float, 3> p{normal(random), normal(random), normal(random)};
    const float length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    float radius = 1.F + 0.1F * std::sin(4.F * p[0] / length) * std::cos(3.F * p[1] / length);
    if (i >= kSurface) radius *= 0.9F * std::cbrt(static_cast<float>(i - kSurface) / 2000.F);
    for (const float x : p) rows.push_back(radius * x / length);
  }
  const PointView points{rows.data(), 3, rows.size() / 3};
  const auto hints = std::make_shared<OrientationHints>();
  for (std::size_t i = 0; i < points.size; ++i) {
    hints->viewpoints.insert(hints->viewpoints.end(), {0.1F, 0.05F, 0.F});
  }
  PipelineOptions options;
  options.orientation.hints = hints;
  const OrientedCloud cloud = orientCloud(points, nullptr, options);
  std::size_t outward = 0;
  for (std::size_t i = 0; i < kSurface; ++i) {
    float along = 0.F;
    for (std::size_t a = 0; a < 3; ++a) along += cloud.normals[4 * i + a] * points[i][a];
    outward += along > 0.F ? 1 : 0;
  }
  EXPECT_GT(outward, kSurface * 99 / 100);
}

TEST(HeightField, WhatIsFullOfPointsIsNoWood) {
  // Below the ground, on either side of it, and no deeper than noise is.
  for (const auto& [from, to] :
       {std::pair(-4.F, -0.5F), std::pair(-2.F, 2.F), std::pair(0.F, 0.3F)}) {
    const std::vector<float> rows = woods(20000, from, to);
    EXPECT_FALSE(findSensors({rows.data(), 3, rows.size() / 3}).sure()) << from;
  }
  // A slab with points inside.
  std::vector<float> slab = woods(20000, 0.5F, 3.5F);
  const std::vector<float> top = plate(10000, 0.F);
  for (std::size_t i = 0; i < top.size(); i += 3) {
    slab.insert(slab.end(), {top[i], top[i + 1], top[i + 2] + 4.F});
  }
  EXPECT_FALSE(findSensors({slab.data(), 3, slab.size() / 3}).sure());
}

// Points under trees lie behind others, which those who fly above see all the same. Of crowns that
// are solid, a place that somebody gives is to be doubted for that; one that was found by layers
// has been.
TEST(HeightField, WhoWasFoundAboveMaySeeThroughTrees) {
  std::vector<float> rows = plate(9000, 0.F);
  for (std::size_t i = 0; i < 9000; ++i) {
    const float x = rows[3 * i];
    const float y = rows[3 * i + 1];
    if (std::fmod(x, 2.F) > 1.F || std::fmod(y, 2.F) > 1.F) continue;
    rows.insert(rows.end(), {x + 0.02F, y, rows[3 * i + 2] + 2.F});
    rows.insert(rows.end(), {x, y + 0.02F, rows[3 * i + 2] + 2.F});
  }
  const PointView points{rows.data(), 3, rows.size() / 3};
  Neighborhoods table;
  search::indexOf(points, 0).nearestKAll(33, table, false);
  const std::vector<float> spacing(points.size, 0.1F);
  for (const bool found : {false, true}) {
    PointHints hints;
    hints.place.found = found;
    for (std::size_t i = 0; i < points.size; ++i) {
      hints.sensors.insert(hints.sensors.end(), {5.F, 5.F, 1000.F});
    }
    const detail::KnownSensors known =
        detail::findKnownSensors(points, table, spacing.data(), hints, 0);
    ASSERT_EQ(known.scans.size(), 1U);
    EXPECT_GT(known.scans[0].hidden, 0.1F);
    EXPECT_EQ(known.scans[0].used, found);
  }
}

}  // namespace
}  // namespace segorient
