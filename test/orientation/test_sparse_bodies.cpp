// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Bodies of few points: the field of all points knows more than neighbourhoods do.
#include "orientation/automatic/sparse_bodies.h"

#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "common/compact_cloud.h"
#include "orientation/winding/consistent_normals.h"
#include "search/index_of.h"

namespace segorient {
namespace {

struct Truth {
  std::vector<float> xyz;
  std::vector<float> normals;

  PointView view() const { return {xyz.data(), 3, xyz.size() / 3}; }
  void add(const std::array<float, 3>& p, const std::array<float, 3>& n) {
    xyz.insert(xyz.end(), p.begin(), p.end());
    normals.insert(normals.end(), n.begin(), n.end());
  }
  /// Share of points whose normal points to the side of the true one.
  double shareRight(const std::vector<float>& found) const {
    std::size_t right = 0;
    for (std::size_t i = 0; i < view().size; ++i) {
      float sum = 0.F;
      for (std::size_t a = 0; a < 3; ++a) sum += found[4 * i + a] * normals[3 * i + a];
      right += sum > 0.F ? 1 : 0;
    }
    return static_cast<double>(right) / static_cast<double>(view().size);
  }
};

// Three bars that cross, half a spacing thick: all neighbourhoods reach through them.
Truth crossedBars(unsigned seed) {
  constexpr float kHalf = 0.06F;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.F, 1.F);
  Truth out;
  for (std::size_t along = 0; along < 3; ++along) {
    for (int i = 0; i < 200; ++i) {
      std::array<float, 3> p{};
      std::array<float, 3> n{};
      const std::size_t across = (along + 1 + static_cast<std::size_t>(i % 2)) % 3;
      for (std::size_t a = 0; a < 3; ++a) p[a] = uniform(random) * (a == along ? 1.F : kHalf);
      n[across] = uniform(random) > 0.F ? 1.F : -1.F;
      p[across] = n[across] * kHalf;
      bool is_inside = false;
      for (std::size_t other = 0; other < 3; ++other) {
        bool within = other != along;
        for (std::size_t a = 0; a < 3; ++a) within &= a == other || std::fabs(p[a]) < kHalf;
        is_inside |= within;
      }
      if (!is_inside) out.add(p, n);
    }
  }
  return out;
}

// A sheet that is rolled up by a turn and a quarter.
Truth roll() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.F, 1.F);
  Truth out;
  for (int i = 0; i < 800; ++i) {
    const float t = 3.F + 8.F * uniform(random);
    const std::array<float, 3> p{t * std::cos(t) / 6.F, t * std::sin(t) / 6.F,
                                 2.F * uniform(random)};
    out.add(p, {std::sin(t) + t * std::cos(t), t * std::sin(t) - std::cos(t), 0.F});
  }
  return out;
}

Truth ball(std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  Truth out;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 3> p{normal(random), normal(random), normal(random)};
    const float length = std::hypot(std::hypot(p[0], p[1]), p[2]);
    for (float& v : p) v /= length;
    out.add(p, p);
  }
  return out;
}

TEST(SparseBodies, BarsThatAreThinnerThanNeighborhoodsFaceOutward) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const Truth bars = crossedBars(seed);
    const OrientedCloud cloud = orientCloud(bars.view(), nullptr, {});
    EXPECT_GT(bars.shareRight(cloud.normals), 0.99) << seed;
  }
}

// Within it w is one and more: a field would face it to itself.
TEST(SparseBodies, ARollStaysWhole) {
  const Truth sheet = roll();
  const OrientedCloud cloud = orientCloud(sheet.view(), nullptr, {});
  const double right = sheet.shareRight(cloud.normals);
  EXPECT_EQ(std::fabs(right - 0.5), 0.5);
}

TEST(SparseBodies, ManyPointsAreLeftToTheirNeighborhoods) {
  for (const std::size_t count : {std::size_t{3200}, std::size_t{3201}}) {
    const Truth truth = ball(count);
    const CompactCloud points = compactCloud(truth.view());
    ASSERT_EQ(points.size(), count);
    Neighborhoods table;
    search::indexOf(points.view(), 1).nearestKAll(9, table, false);
    detail::AutoNormals found;
    found.spacing = 3.5F / std::sqrt(static_cast<float>(count)) / points.unit;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t row = 3 * static_cast<std::size_t>(points.source[i]);
      found.normals.insert(found.normals.end(), {truth.normals[row], truth.normals[row + 1],
                                                 truth.normals[row + 2], 0.F});
    }
    found.confidences.assign(count, 1.F);
    const std::vector<float> before = found.normals;
    EXPECT_EQ(detail::takeSparseField(points.view(), table, 0.F, 2, found), count <= 3200);
    EXPECT_EQ(before != found.normals, count <= 3200);
  }
}

// Noise of a spacing: the field would fold.
TEST(SparseBodies, NoisyBallsAndBowlsStayRight) {
  for (const float lowest : {-2.F, 0.F}) {
    const Truth clean = ball(lowest < -1.F ? 1000 : 2000);
    std::mt19937 random(11);
    std::normal_distribution<float> noise(0.F, 0.1F);
    Truth noisy;
    for (std::size_t i = 0; i < clean.view().size; ++i) {
      const float* p = clean.view()[i];
      if (p[2] < lowest) continue;
      noisy.add({p[0] + noise(random), p[1] + noise(random), p[2] + noise(random)},
                {p[0], p[1], p[2]});
    }
    const OrientedCloud cloud = orientCloud(noisy.view(), nullptr, {});
    const double right = noisy.shareRight(cloud.normals);
    EXPECT_GT(lowest < -1.F ? right : std::max(right, 1.0 - right), 0.99) << lowest;
  }
}

TEST(ConsistentNormals, OfABallPointOutward) {
  const Truth truth = ball(500);
  const CompactCloud points = compactCloud(truth.view());
  const float spacing = 0.16F / points.unit;
  const std::vector<float> areas(points.size(), spacing * spacing);
  const ConsistentNormals found =
      consistentNormals(points.view(), areas, {spacing, 0.25F * spacing}, 1);
  double steep = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float* n = &found.normals[4 * i];
    const std::size_t row = 3 * static_cast<std::size_t>(points.source[i]);
    float sum = 0.F;
    float square = 0.F;
    for (std::size_t a = 0; a < 3; ++a) {
      sum += n[a] * truth.normals[row + a];
      square += n[a] * n[a];
    }
    EXPECT_GT(sum, 0.5F) << i;
    EXPECT_NEAR(square, 1.F, 1e-5F) << i;
    steep += static_cast<double>(found.steepness[i]);
  }
  EXPECT_NEAR(steep / static_cast<double>(points.size()), 1.0, 0.3);
  const ConsistentNormals again =
      consistentNormals(points.view(), areas, {spacing, 0.25F * spacing}, 2);
  EXPECT_EQ(found.normals, again.normals);
  EXPECT_EQ(found.steepness, again.steepness);
}

TEST(ConsistentNormals, WhatHasNoExtentHasNone) {
  const std::vector<float> place{1.F, 2.F, 3.F, 0.F};
  const ConsistentNormals one = consistentNormals({place.data(), 4, 1}, {1.F}, {1.F, 0.5F}, 1);
  EXPECT_EQ(one.normals, std::vector<float>(4, 0.F));
  EXPECT_EQ(one.steepness, std::vector<float>(1, 0.F));
  EXPECT_TRUE(consistentNormals({nullptr, 4, 0}, {}, {1.F, 0.5F}, 1).normals.empty());
}

}  // namespace
}  // namespace segorient
