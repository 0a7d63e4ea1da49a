// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Normals at fault on surfaces whose truth is known.
#include <gtest/gtest.h>
#include <segorient/orientation/check_normals.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

namespace segorient::test {
namespace {

constexpr std::size_t kPoints = 2000;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Sample {
  std::vector<float> xyz;
  std::vector<float> normals;
  std::size_t size() const { return xyz.size() / 3; }
  PointView view() const { return {xyz.data(), 3, size()}; }
  void turn(std::size_t i) {
    for (std::size_t a = 0; a < 3; ++a) normals[3 * i + a] = -normals[3 * i + a];
  }
};

void addSphere(float x, float radius, std::size_t count, unsigned seed, float noise,
               Sample& sample) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> gauss;
  for (std::size_t i = 0; i < count; ++i) {
    const float v[3] = {gauss(rng), gauss(rng), gauss(rng)};
    const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const float r = radius + noise * gauss(rng);
    for (std::size_t a = 0; a < 3; ++a) {
      sample.xyz.push_back(v[a] / length * r + (a == 0 ? x : 0.F));
      sample.normals.push_back(v[a] / length);
    }
  }
}

Sample sphere(unsigned seed = 5, float noise = 0.F) {
  Sample out;
  addSphere(0.F, 1.F, kPoints, seed, noise, out);
  return out;
}

NormalCheck check(const Sample& sample, const OrientationHints& hints = {}) {
  PipelineOptions options;
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  const OrientedCloud ours = orientCloud(sample.view(), nullptr, options);
  return checkNormals(sample.view(), sample.normals, ours, hints);
}

TEST(CheckNormals, RightOnesAreRightWithNoiseAsWell) {
  for (const float noise : {0.F, 0.02F}) {
    const NormalCheck found = check(sphere(7, noise));
    EXPECT_TRUE(found.places.empty()) << noise;
    EXPECT_EQ(found.at_fault, 0U);
    EXPECT_GT(found.judged, kPoints - kPoints / 40);
    EXPECT_EQ(found.faults.size(), kPoints);
  }
}

TEST(CheckNormals, ACapThatIsTurnedOver) {
  Sample sample = sphere();
  std::size_t turned = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (sample.xyz[3 * i + 2] < 0.8F) continue;
    sample.turn(i);
    ++turned;
  }
  const NormalCheck found = check(sample);
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].fault, NormalFault::SURFACE);
  EXPECT_EQ(found.places[0].points, turned);
  EXPECT_NEAR(found.places[0].center[2], 0.9, 0.03);
  EXPECT_NEAR(found.places[0].size, 1.2, 0.1);
  for (std::size_t i = 0; i < sample.size(); ++i) {
    EXPECT_EQ(found.place_of[i] == 0, sample.xyz[3 * i + 2] >= 0.8F);
  }
}

TEST(CheckNormals, ScatteredOnesProveNothing) {
  Sample sample = sphere();
  for (std::size_t i = 0; i < sample.size(); i += 20) sample.turn(i);
  EXPECT_TRUE(check(sample).places.empty());
}

TEST(CheckNormals, OneOfTwoBallsInsideOut) {
  Sample sample;
  addSphere(0.F, 1.F, kPoints, 1, 0.F, sample);
  addSphere(5.F, 0.5F, 1000, 2, 0.F, sample);
  for (std::size_t i = kPoints; i < kPoints + 1000; ++i) sample.turn(i);
  const NormalCheck found = check(sample);
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].fault, NormalFault::INSIDE_OUT);
  EXPECT_EQ(found.places[0].points, 1000U);
  EXPECT_NEAR(found.places[0].center[0], 5.0, 0.05);
}

// The walls of a cavity point into it.
TEST(CheckNormals, ACavityIsRight) {
  Sample sample;
  addSphere(0.F, 1.F, 3000, 1, 0.F, sample);
  addSphere(0.F, 0.5F, 1000, 2, 0.F, sample);
  EXPECT_EQ(check(sample).places.size(), 1U) << "no cavity if both point away from the middle";
  for (std::size_t i = 3000; i < 4000; ++i) sample.turn(i);
  EXPECT_TRUE(check(sample).places.empty());
}

Sample halfSphere() {
  Sample whole = sphere(9);
  Sample out;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole.xyz[3 * i + 2] < 0.3F) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      out.xyz.push_back(whole.xyz[3 * i + a]);
      out.normals.push_back(whole.normals[3 * i + a]);
    }
  }
  return out;
}

TEST(CheckNormals, AnOpenSurfaceHasTheSideThatItsOwnerMeans) {
  Sample sample = halfSphere();
  OrientationHints hints;
  hints.surface = SurfaceKind::OPEN;
  EXPECT_TRUE(check(sample, hints).places.empty());
  for (std::size_t i = 0; i < sample.size(); ++i) sample.turn(i);
  EXPECT_TRUE(check(sample, hints).places.empty());
}

TEST(CheckNormals, UnlessASensorSawIt) {
  Sample sample = halfSphere();
  OrientationHints hints;
  hints.has_direction = true;
  hints.scans.assign(sample.size(), 4);
  EXPECT_TRUE(check(sample, hints).places.empty());
  for (std::size_t i = 0; i < sample.size(); ++i) sample.turn(i);
  const NormalCheck found = check(sample, hints);
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].fault, NormalFault::SENSOR);
  EXPECT_EQ(found.places[0].scan, 4);
  ASSERT_EQ(found.scans.size(), 1U);
  EXPECT_EQ(found.scans[0].against_sensor, found.scans[0].judged);
  EXPECT_GT(found.scans[0].judged, sample.size() / 2);
}

TEST(CheckNormals, WhatHasNoNormalOrAnotherLineIsCounted) {
  Sample sample = sphere();
  sample.normals[0] = kNaN;
  sample.normals[3] = sample.normals[4] = sample.normals[5] = 0.F;
  sample.xyz[6] = kNaN;
  const float* n = &sample.normals[9];  // at right angles to what it was
  const float across[3] = {n[1], -n[0], 0.F};
  std::copy_n(across, 3, &sample.normals[9]);
  const NormalCheck found = check(sample);
  EXPECT_EQ(found.without_normal, 3U);
  EXPECT_EQ(found.unlike, 1U);
  EXPECT_EQ(found.judged + 4U, sample.size());
}

TEST(CheckNormals, SizesThatDoNotAgreeAndNothingAtAll) {
  const Sample sample = sphere();
  EXPECT_TRUE(checkNormals(sample.view(), {1.F, 0.F, 0.F}, {}, {}).faults.empty());
  EXPECT_TRUE(checkNormals({}, {}, {}, {}).faults.empty());
}

TEST(CheckNormals, ThreadsDoNotMatter) {
  Sample sample = sphere(3, 0.01F);
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (sample.xyz[3 * i] > 0.7F) sample.turn(i);
  }
  PipelineOptions options;
  const OrientedCloud ours = orientCloud(sample.view(), nullptr, options);
  const NormalCheck one = checkNormals(sample.view(), sample.normals, ours, {}, 1);
  const NormalCheck two = checkNormals(sample.view(), sample.normals, ours, {}, 2);
  EXPECT_EQ(one.faults, two.faults);
  EXPECT_EQ(one.place_of, two.place_of);
}

}  // namespace
}  // namespace segorient::test
