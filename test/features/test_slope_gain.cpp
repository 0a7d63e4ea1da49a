// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "feature_clouds.h"
#include "features/slope_gain.h"

namespace segorient::test {
namespace {

constexpr std::array<float, 3> kUp{0.F, 0.F, 1.F};

// Of the first of some points in the plane z = 0, whose neighbours all the others are.
bool tells(const std::vector<std::array<float, 2>>& points, double most = detail::kMostGain) {
  Sample sample;
  for (const auto& [x, y] : points) sample.add({x, y, 0.F}, Eigen::Vector3f::UnitZ());
  const int k = static_cast<int>(points.size()) - 1;
  const Neighborhoods table = neighborsOf(sample.view(), k);
  return detail::tellsSlope({sample.view(), sample.view(), table}, 0, k, kUp.data(), most);
}

TEST(SlopeGain, ConicsTellNothing) {
  std::vector<std::array<float, 2>> two_lines;
  std::vector<std::array<float, 2>> circle;
  std::vector<std::array<float, 2>> corner;
  for (int i = 0; i < 12; ++i) {
    const auto t = static_cast<float>(i);
    two_lines.push_back({(i % 4 < 2 ? 0.3F : -0.3F) * t, i % 2 == 0 ? 0.F : 1.F});
    circle.push_back({std::cos(0.2F * t), std::sin(0.2F * t)});
    corner.push_back({i % 2 == 0 ? t : 0.F, i % 2 == 0 ? 0.F : t});
  }
  EXPECT_FALSE(tells(two_lines, detail::kGainOnConic));
  EXPECT_FALSE(tells(circle, detail::kGainOnConic));
  EXPECT_FALSE(tells(corner, detail::kGainOnConic));
  // A third line tells which of all surfaces through two it is.
  for (int i = 0; i < 4; ++i) two_lines.push_back({static_cast<float>(i) - 1.5F, -1.F});
  EXPECT_TRUE(tells(two_lines));
}

TEST(SlopeGain, FewerThanCoefficients) {
  EXPECT_FALSE(tells({{0.F, 0.F}, {1.F, 0.F}, {0.F, 1.F}, {1.F, 1.F}, {2.F, 3.F}}));
}

// The shares that the constants state.
TEST(SlopeGain, RandomPointsTell) {
  constexpr int kRounds = 2000;
  std::mt19937 rng(11);
  std::uniform_real_distribution<float> angle(0.F, 6.2831853F);
  std::uniform_real_distribution<float> square(0.F, 1.F);
  const auto failing = [&](int k, double most) {
    int silent = 0;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::array<float, 2>> points{{0.F, 0.F}};
      for (int i = 0; i < k; ++i) {
        const float r = std::sqrt(square(rng));
        const float a = angle(rng);
        points.push_back({r * std::cos(a), r * std::sin(a)});
      }
      silent += tells(points, most) ? 0 : 1;
    }
    return static_cast<double>(silent) / kRounds;
  };
  EXPECT_LT(failing(10, detail::kMostGain), 0.15);
  EXPECT_LT(failing(16, detail::kMostGain), 0.015);
  EXPECT_LT(failing(8, detail::kGainOnConic), 0.003);
}

}  // namespace
}  // namespace segorient::test
