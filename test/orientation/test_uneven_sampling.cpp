// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Open surfaces whose points lie eight times as dense in some stripes as in others. Few normals
// beside a stripe's border are reliable, and yet all of the border says the same.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "sheet_fixture.h"

namespace segorient::test {
namespace {

// Six stripes across a length of 2 along some direction.
class Stripes {
 public:
  explicit Stripes(std::mt19937& rng) {
    std::normal_distribution<double> normal;
    double length = 0.0;
    for (double& a : along_) {
      a = normal(rng);
      length += a * a;
    }
    for (double& a : along_) a /= std::sqrt(length);
    phase_ = std::uniform_real_distribution<double>(0, 2 * M_PI)(rng);
  }
  bool keep(const std::array<double, 3>& p, std::mt19937& rng) const {
    const double at = p[0] * along_[0] + p[1] * along_[1] + p[2] * along_[2];
    return std::sin(6 * M_PI * at + phase_) > 0 || rng() % 8 == 0;
  }

 private:
  std::array<double, 3> along_{};
  double phase_ = 0.0;
};

TrueNormals halfSphere(std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Stripes stripes(rng);
  TrueNormals out;
  while (out.xyz.size() < 4 * count) {
    const double z = unit(rng);
    const double t = 2 * M_PI * unit(rng);
    const double r = std::sqrt(1 - z * z);
    const std::array<double, 3> p{r * std::cos(t), r * std::sin(t), z};
    if (stripes.keep(p, rng)) out.add(p, p);
  }
  return out;
}

// Two and a half turns, six spacings apart on average.
TrueNormals roll(std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Stripes stripes(rng);
  const double widening = 6 * std::sqrt(12.0 / static_cast<double>(count)) / (2 * M_PI);
  const auto radius = [&](double t) { return 0.35 + widening * t; };
  const double turns = 5 * M_PI;
  TrueNormals out;
  while (out.xyz.size() < 4 * count) {
    const double t = turns * unit(rng);
    if (unit(rng) * radius(turns) > radius(t)) continue;
    const double c = std::cos(t);
    const double s = std::sin(t);
    const std::array<double, 3> p{radius(t) * c, radius(t) * s, 1.5 * unit(rng)};
    if (stripes.keep(p, rng)) {
      out.add(p, {widening * s + radius(t) * c, radius(t) * s - widening * c, 0.0});
    }
  }
  return out;
}

double shareOfOneSide(const TrueNormals& cloud) {
  const OrientedCloud oriented = orientCloud(viewOf(cloud.xyz), nullptr, PipelineOptions{});
  const double share = shareOutward(oriented.normals, cloud.normals);
  return std::max(share, 1 - share);
}

TEST(UnevenSampling, StripesOfAHalfSphereFaceOneWay) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    EXPECT_GE(shareOfOneSide(halfSphere(3000, seed)), 0.999) << seed;
  }
}

// Borders across which hardly a normal is reliable decide against shorter ones across the gap.
TEST(UnevenSampling, StripesOfARollFaceOneWay) {
  for (const unsigned seed : {16U, 17U}) {
    EXPECT_GE(shareOfOneSide(roll(5000, seed)), 0.999) << seed;
  }
}

// All of the largest part could have been seen from one place, which is no reason to turn over what
// is joined to it without a contradiction.
TEST(UnevenSampling, NoGuessedViewpointTurnsSmoothSurfaces) {
  for (const unsigned seed : {11U, 18U, 19U}) {
    EXPECT_GE(shareOfOneSide(roll(5000, seed)), 0.999) << seed;
  }
}

}  // namespace
}  // namespace segorient::test
