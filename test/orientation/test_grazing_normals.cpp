// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Normals that say "seen at a grazing angle" on what was seen face on; the plane is the oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "orientation/automatic/grazing_normals.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

// A noisy plane z = 0 of 40 x 40 points, each with the same sensor direction and normal.
struct Seen {
  std::vector<float> xyz;
  std::vector<float> toward;
  FilteredNormals normals;

  Seen(const std::array<float, 3>& sensor, const std::array<float, 3>& normal) {
    std::mt19937 rng(7);
    std::normal_distribution<float> gauss(0.F, 0.2F);
    for (int i = 0; i < 1600; ++i) {
      const auto x = static_cast<float>(i % 40);
      const auto y = static_cast<float>(i / 40);
      xyz.insert(xyz.end(), {x, y, gauss(rng), 0.F});
      toward.insert(toward.end(), sensor.begin(), sensor.end());
      normals.normals.insert(normals.normals.end(), {normal[0], normal[1], normal[2], 0.F});
    }
    normals.confidences.assign(1600, 1.F);
  }
  void run(int threads = 1) {
    detail::MoreNeighbors more(viewOf(xyz), threads);
    detail::replaceGrazingNormals(more, toward, threads, normals);
  }
};

TEST(GrazingNormals, BecomeThoseOfThePlaneSeenFaceOn) {
  Seen seen({0.F, 0.F, 1.F}, {0.96F, 0.F, -0.28F});
  // Two points whose sensor is not known, and one that agrees with the plane, are left alone.
  for (const std::size_t i : {5U, 900U}) std::fill_n(seen.toward.begin() + 3 * i, 3, 0.F);
  const std::array<float, 3> tilted{0.6F, 0.F, 0.8F};
  std::copy(tilted.begin(), tilted.end(), seen.normals.normals.begin() + 4 * 700);
  const std::vector<float> before = seen.normals.normals;
  seen.run();
  for (std::size_t i = 0; i < 1600; ++i) {
    const float* n = seen.normals.normals.data() + 4 * i;
    if (i == 5 || i == 900 || i == 700) {
      EXPECT_TRUE(std::equal(n, n + 4, before.begin() + static_cast<std::ptrdiff_t>(4 * i))) << i;
    } else {
      EXPECT_GT(n[2], std::cos(10.0 * M_PI / 180)) << i;
    }
  }
}

TEST(GrazingNormals, WhatReallyWasSeenSoStays) {
  Seen seen({0.99F, 0.F, 0.14F}, {0.F, 0.F, 1.F});
  const std::vector<float> before = seen.normals.normals;
  seen.run();
  EXPECT_EQ(seen.normals.normals, before);
}

TEST(GrazingNormals, ThreadsDoNotMatterAndNaNStays) {
  Seen one({0.F, 0.F, 1.F}, {1.F, 0.F, 0.F});
  std::fill_n(one.normals.normals.begin() + 40, 4, std::nanf(""));
  Seen many = one;
  one.run(1);
  many.run(3);
  EXPECT_TRUE(std::isnan(one.normals.normals[40]));
  one.normals.normals[40] = many.normals.normals[40] = 0.F;
  for (std::size_t i = 0; i < one.normals.normals.size(); ++i) {
    if (i / 4 == 10) continue;
    EXPECT_EQ(one.normals.normals[i], many.normals.normals[i]) << i;
  }
}

TEST(GrazingNormals, TooFewPointsForAPlaneStay) {
  Seen seen({0.F, 0.F, 1.F}, {1.F, 0.F, 0.F});
  seen.xyz.resize(8);
  seen.toward.resize(6);
  seen.normals.normals.resize(8);
  const std::vector<float> before = seen.normals.normals;
  seen.run();
  EXPECT_EQ(seen.normals.normals, before);
}

}  // namespace
}  // namespace segorient::test
