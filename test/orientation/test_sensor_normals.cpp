// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Final normals where the sensor is known; the true faces of a corner are the oracle.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "orientation/automatic/sensor_normals.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

// The floor z = 0 and the wall x = 0 of a room, 30 x 30 points each, seen from one place.
struct Corner {
  std::vector<float> xyz;
  std::vector<float> truth;
  std::vector<float> toward;
  std::vector<float> normals;

  explicit Corner(float noise, std::array<float, 3> sensor = {20.F, 15.F, 15.F}) {
    std::mt19937 rng(3);
    std::normal_distribution<float> gauss(0.F, 1.F);
    for (int face = 0; face < 2; ++face) {
      for (int i = 0; i < 900; ++i) {
        const float a = static_cast<float>(i % 30) + 0.2F * gauss(rng) + 0.5F;
        const float b = static_cast<float>(i / 30) + 0.2F * gauss(rng);
        const float off = noise * gauss(rng);
        const std::array<float, 3> p =
            face == 0 ? std::array<float, 3>{a, b, off} : std::array<float, 3>{off, b, a};
        xyz.insert(xyz.end(), {p[0], p[1], p[2], 0.F});
        truth.insert(truth.end(), {face == 0 ? 0.F : 1.F, 0.F, face == 0 ? 1.F : 0.F, 0.F});
        std::array<float, 3> v{};
        for (std::size_t k = 0; k < 3; ++k) v[k] = sensor[k] - p[k];
        const float length = std::sqrt(dot3(v.data(), v.data()));
        for (std::size_t k = 0; k < 3; ++k) toward.push_back(v[k] / length);
      }
    }
    normals = truth;
  }
  std::size_t size() const { return xyz.size() / 4; }
  void run(int threads = 1, const std::vector<std::uint8_t>& sure = {}) {
    detail::MoreNeighbors more(viewOf(xyz), threads);
    detail::leanToSensors(more, neighborsOf(xyz), toward, sure, false, threads, normals);
  }
};

TEST(SensorNormals, WhatIsSureStaysAtGrazingAngles) {
  Corner corner(0.F, {20.F, 15.F, 0.5F});
  corner.run();
  std::size_t inner = 0;
  for (std::size_t i = 0; i < corner.size(); ++i) {
    EXPECT_GT(dot3(&corner.normals[4 * i], &corner.toward[3 * i]), 0.F) << i;
    if (corner.xyz[4 * i] < 8.F) continue;  // what is near the wall sees it
    ++inner;
    EXPECT_GT(dot3(&corner.normals[4 * i], &corner.truth[4 * i]), std::cos(2.0 * M_PI / 180)) << i;
  }
  EXPECT_GT(inner, 500U);
}

TEST(SensorNormals, WhatOneSurfaceExplainsStaysBesideAnEdge) {
  Corner corner(0.F);
  corner.run(1, std::vector<std::uint8_t>(corner.size(), 1));
  std::size_t seen = 0;
  for (std::size_t i = 0; i < corner.size(); ++i) {
    if (dot3(&corner.truth[4 * i], &corner.toward[3 * i]) < 0.35F) continue;  // grazing
    ++seen;
    EXPECT_GT(dot3(&corner.normals[4 * i], &corner.truth[4 * i]), std::cos(1.0 * M_PI / 180)) << i;
  }
  EXPECT_GT(seen, corner.size() / 2);
  // Unless it turns its back to its sensor.
  for (std::size_t i = 0; i < corner.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) corner.normals[4 * i + a] = -corner.toward[3 * i + a];
  }
  corner.normals[0] += 0.2F;
  corner.run(1, std::vector<std::uint8_t>(corner.size(), 1));
  EXPECT_GT(dot3(&corner.normals[0], &corner.toward[0]), 0.F);
}

TEST(SensorNormals, PointsThatTookTheOtherFacesNormalBesideAnEdgeKeepTheirSide) {
  Corner corner(0.25F);
  // Beside the edge noise mixes the faces up: half of the points have the other one's normal,
  // tilted so that it turns its back to their own.
  std::mt19937 rng(5);
  std::size_t mixed = 0;
  for (std::size_t i = 0; i < corner.size(); ++i) {
    const bool floor = corner.truth[4 * i + 2] > 0.5F;
    if ((floor ? corner.xyz[4 * i] : corner.xyz[4 * i + 2]) > 1.5F || rng() % 2 == 0) continue;
    const float away = -0.1F;
    const float length = std::sqrt(1.F + away * away);
    const std::array<float, 3> n = floor ? std::array<float, 3>{1.F / length, 0.F, away / length}
                                         : std::array<float, 3>{away / length, 0.F, 1.F / length};
    std::copy(n.begin(), n.end(), &corner.normals[4 * i]);
    ++mixed;
  }
  ASSERT_GT(mixed, 30U);
  ASSERT_LT(shareOutward(corner.normals, corner.truth), 0.985);
  corner.run();
  EXPECT_EQ(shareOutward(corner.normals, corner.truth), 1.0);
  EXPECT_GT(shareWithin(corner.normals, corner.truth, 15.0), 0.85);
}

// Above a scanner lines crowd. The normals of 300 points along one, at 53 degrees from the ray:
// noise that is twice as wide as the points are apart says nothing for them, and lines without it
// nothing against them.
TEST(SensorNormals, AlongANoisyLineNormalsFollowTheRay) {
  for (const float noise : {0.F, 2.F}) {
    Corner line(0.F);
    const std::size_t n = 300;
    std::mt19937 rng(7);
    std::normal_distribution<float> gauss(0.F, 1.F);
    line.xyz.assign(4 * n, 0.F);
    line.normals.assign(4 * n, 0.F);
    line.toward.assign(3 * n, 0.F);
    for (std::size_t i = 0; i < n; ++i) {
      line.xyz[4 * i] = static_cast<float>(i);
      for (std::size_t a = 1; a < 3; ++a) line.xyz[4 * i + a] = noise * gauss(rng);
      line.normals[4 * i + 1] = 0.8F;
      line.normals[4 * i + 2] = 0.6F;
      line.toward[3 * i + 2] = 1.F;
    }
    line.run();
    double cosine = 0.0;
    for (std::size_t i = 0; i < n; ++i) cosine += static_cast<double>(line.normals[4 * i + 2]) / n;
    if (noise > 0.F) {
      EXPECT_GT(cosine, 0.85);
    } else {
      EXPECT_LT(cosine, 0.65);
    }
  }
}

TEST(SensorNormals, WithoutASensorOrANormalNothingIsChanged) {
  Corner corner(0.25F);
  for (const std::size_t i : {10U, 1000U}) {
    std::fill_n(&corner.toward[3 * i], 3, 0.F);
    corner.normals[4 * i] = 0.6F;
    corner.normals[4 * i + 3] = 7.F;
  }
  std::fill_n(&corner.normals[4 * 20], 4, std::nanf(""));
  const std::vector<float> before = corner.normals;
  corner.run();
  for (const std::size_t i : {10U, 1000U}) {
    EXPECT_TRUE(std::equal(&corner.normals[4 * i], &corner.normals[4 * i + 4], &before[4 * i]));
  }
  EXPECT_TRUE(std::isnan(corner.normals[80]));
  std::size_t finite = 0;
  for (const float v : corner.normals) finite += std::isfinite(v) ? 1U : 0U;
  EXPECT_EQ(finite, corner.normals.size() - 4);
}

TEST(SensorNormals, ThreadsDoNotMatter) {
  Corner one(0.25F);
  Corner many = one;
  one.run(1);
  many.run(3);
  EXPECT_EQ(one.normals, many.normals);
}

TEST(SensorNormals, FewPointsAndNone) {
  Corner corner(0.F);
  for (const std::size_t n : {2U, 1U, 0U}) {
    corner.xyz.resize(4 * n);
    corner.toward.resize(3 * n);
    corner.normals.resize(4 * n);
    corner.run();
    for (const float v : corner.normals) EXPECT_TRUE(std::isfinite(v));
  }
}

}  // namespace
}  // namespace segorient::test
