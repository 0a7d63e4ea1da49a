// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Sheets that only the field of all points wants to turn over in part.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "orientation/automatic/torn_sheets.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

// A square with normals up, of 40 x 40 points at random.
struct Square {
  std::vector<float> xyz;
  std::vector<float> normals;
  std::vector<std::uint8_t> inner;  // a disc in the middle

  explicit Square(float thickness = 0.F) {
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> place(-20.F, 20.F);
    std::uniform_real_distribution<float> height(-thickness, thickness);
    for (int i = 0; i < 1600; ++i) {
      const float x = place(rng);
      const float y = place(rng);
      for (const float v : {x, y, height(rng), 0.F}) xyz.push_back(v);
      for (const float v : {0.F, 0.F, 1.F, 0.F}) normals.push_back(v);
      inner.push_back(x * x + y * y < 100.F ? 1 : 0);
    }
  }
  std::vector<std::uint8_t> turned(std::vector<std::uint8_t> asked) const {
    detail::keepSheetsWhole(neighborsOf(xyz), normals, asked);
    return asked;
  }
};

TEST(TornSheets, APatchWithinOneSheetStays) {
  const Square square;
  EXPECT_EQ(square.turned(square.inner), std::vector<std::uint8_t>(1600, 0));
}

TEST(TornSheets, APatchThatContradictsItsSurroundingsIsTurned) {
  Square square;
  for (std::size_t i = 0; i < 1600; ++i) square.normals[4 * i + 2] = square.inner[i] ? -1.F : 1.F;
  EXPECT_EQ(square.turned(square.inner), square.inner);
}

// The lower half of a slab, as thin as noise: each point has neighbours in the upper one.
TEST(TornSheets, OneSideOfAWallIsTurned) {
  const Square slab(0.5F);
  std::vector<std::uint8_t> lower;
  for (std::size_t i = 0; i < 1600; ++i) lower.push_back(slab.xyz[4 * i + 2] < 0.F ? 1 : 0);
  const std::vector<std::uint8_t> turned = slab.turned(lower);
  EXPECT_GE(std::count(turned.begin(), turned.end(), 1), 700);
}

TEST(TornSheets, WhatHasNoNormalsIsNoSheet) {
  Square square;
  std::fill(square.normals.begin(), square.normals.end(), std::nanf(""));
  EXPECT_EQ(square.turned(std::vector<std::uint8_t>(1600, 0)), std::vector<std::uint8_t>(1600, 0));
}

// Two and a half turns, six spacings apart, in noise of a third of one: within the roll the winding
// number is one and two more than it is outside, and its field wants the inmost turn the other way.
TEST(TornSheets, ARollInNoiseStaysOneSheet) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> gauss;
  constexpr std::size_t kPoints = 12000;
  const double spacing = std::sqrt(12.0 / kPoints);
  const double growth = 6.0 * spacing / (2.0 * M_PI);
  std::vector<float> xyz;
  std::vector<float> normals;
  while (xyz.size() < 4 * kPoints) {
    const double t = 5.0 * M_PI * unit(rng);
    const double r = 0.35 + growth * t;
    if (unit(rng) * (0.35 + growth * 5.0 * M_PI) > r) continue;  // even over the sheet
    const double n[3] = {growth * std::sin(t) + r * std::cos(t),
                         r * std::sin(t) - growth * std::cos(t), 0.0};
    const double length = std::hypot(n[0], n[1]);
    const double p[3] = {r * std::cos(t), r * std::sin(t), 1.5 * unit(rng)};
    for (std::size_t a = 0; a < 3; ++a) {
      xyz.push_back(static_cast<float>(p[a] + 0.3 * spacing * gauss(rng)));
      normals.push_back(static_cast<float>(n[a] / length));
    }
    xyz.push_back(0.F);
    normals.push_back(0.F);
  }
  const double share = shareOutward(orientCloud(viewOf(xyz), nullptr, {}).normals, normals);
  EXPECT_GE(std::max(share, 1.0 - share), 0.995);
}

}  // namespace
}  // namespace segorient::test
