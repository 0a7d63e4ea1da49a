// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "feature_clouds.h"
#include "features/automatic_normals.h"
#include "features/local_normals.h"

namespace segorient::test {
namespace {

struct Automatic {
  std::vector<float> normals;
  AutomaticNormalReport report;
};

Automatic automatic(const Sample& sample) {
  Automatic result;
  result.normals.resize(4 * sample.normals.size());
  const Neighborhoods table = neighborsOf(sample.view(), kMostAutomaticNeighbors);
  result.report = estimateNormalsAutomatically(sample.view(), table, 0, result.normals.data());
  return result;
}

// With a table of k neighbours, and an index of the points for more.
Automatic automaticWithIndex(const Sample& sample, int k) {
  search::MedianHashIndex index;
  index.build(sample.view(), nullptr, {});
  Automatic result;
  result.normals.resize(4 * sample.normals.size());
  result.report = estimateNormalsAutomatically(sample.view(), index, neighborsOf(sample.view(), k),
                                               0, result.normals.data());
  return result;
}

double rmsOf(const Sample& sample, NormalEstimator estimator, int k) {
  LocalNormalOptions options;
  options.estimator = estimator;
  options.k = k;
  std::vector<float> normals(4 * sample.normals.size());
  estimateNormals(sample.view(), neighborsOf(sample.view(), k), options, normals.data());
  return rmsDegrees(sample, normals);
}

double bestSingle(const Sample& sample) {
  double best = std::numeric_limits<double>::infinity();
  for (const int k : {8, 12, 20, 32, 64}) {
    for (const auto estimator : {NormalEstimator::PLANE, NormalEstimator::LCT, NormalEstimator::LDT,
                                 NormalEstimator::AWAS_QUADRATIC}) {
      best = std::min(best, rmsOf(sample, estimator, k));
    }
  }
  return best;
}

Sample noisyCube(std::size_t count, float noise) {
  Sample sample = cube(count, 2);
  std::mt19937 generator(3);
  std::normal_distribution<float> offset(0.F, noise * std::sqrt(24.F / static_cast<float>(count)));
  for (auto& p : sample.points) {
    p.getVector3fMap() += Eigen::Vector3f::NullaryExpr([&] { return offset(generator); });
  }
  return sample;
}

// Offsets of a point from a fitted surface are noise across it only: the estimate is that of the
// normal component, over the distance to the nearest points.
TEST(NoiseEstimate, GrowsWithTheNoise) {
  const auto estimateNoise = [](const Sample& sample, int k) {
    const Neighborhoods table = neighborsOf(sample.view(), k);
    return detail::sampleNoise(sample.view(), table, 0).in_spacings;
  };
  for (const float noise : {0.05F, 0.1F, 0.2F}) {
    const double estimate = estimateNoise(torus(20000, 1, noise * torusSpacing(20000)), 16);
    EXPECT_GT(estimate / static_cast<double>(noise), 0.8) << noise;
    EXPECT_LT(estimate / static_cast<double>(noise), 1.6) << noise;
  }
  EXPECT_LT(estimateNoise(torus(20000, 1), 16), 0.01);
  EXPECT_EQ(estimateNoise(torus(10, 1), 9), 0.0);
}

TEST(AutomaticNormals, AsGoodAsTheBestSingleEstimator) {
  const float h = torusSpacing(8000);
  for (const float noise : {0.F, 0.25F, 0.5F}) {
    const Sample smooth = torus(8000, 2, noise * h);
    EXPECT_LT(rmsDegrees(smooth, automatic(smooth).normals), 1.25 * bestSingle(smooth) + 0.02)
        << noise;
  }
  const Sample edges = cube(10000, 2);
  EXPECT_LT(rmsDegrees(edges, automatic(edges).normals), bestSingle(edges));
}

// A formula's surface without noise is nearly cubic everywhere, a solid with edges is not, nor is
// what noise makes of it.
TEST(AutomaticNormals, CubicSurfacesWhereASmoothCloudHasNoNoise) {
  const Sample smooth = torus(20000, 2);
  const Automatic cubic = automatic(smooth);
  EXPECT_TRUE(cubic.report.analytic);
  EXPECT_NE(cubic.report.text().find("cubic ones of 12"), std::string::npos);
  EXPECT_EQ(cubic.report.surfaces[0].second + cubic.report.at_edges, 20000U);
  EXPECT_LT(rmsDegrees(smooth, cubic.normals),
            0.5 * rmsOf(smooth, NormalEstimator::AWAS_QUADRATIC, 10));
  EXPECT_FALSE(automatic(cube(10000, 2)).report.analytic);
  EXPECT_FALSE(automatic(torus(20000, 2, 0.05F * torusSpacing(20000))).report.analytic);
}

// Where points are few for how much a smooth surface bends, quadratic surfaces are as good as it
// gets; an edge of the same residuals is left to triangulations.
TEST(AutomaticNormals, BendsAreNoEdges) {
  const Sample smooth = torus(400, 7);
  const Automatic bends = automatic(smooth);
  EXPECT_LT(bends.report.at_edges, 100U);
  EXPECT_LT(rmsDegrees(smooth, bends.normals),
            1.1 * rmsOf(smooth, NormalEstimator::AWAS_QUADRATIC, 10));
  EXPECT_GT(automatic(cube(400, 7)).report.at_edges, 150U);
}

// Across a noisy edge cubic surfaces bend where small quadratic ones smooth and local
// triangulations are noisy. Without edges nothing is to be gained.
TEST(AutomaticNormals, CubicSurfacesAtNoisyEdges) {
  const Sample edges = noisyCube(20000, 0.13F);
  const Automatic result = automatic(edges);
  EXPECT_TRUE(result.report.cubic);
  EXPECT_LT(rmsDegrees(edges, result.normals), 0.9 * bestSingle(edges));
  EXPECT_FALSE(automatic(torus(20000, 2, 0.13F * torusSpacing(20000))).report.cubic);
}

// Two flat sheets that pass each other at a few spacings: where surfaces of ten neighbours take in
// both, the nearest six lie on one of them.
TEST(AutomaticNormals, NarrowGaps) {
  const float h = 0.01F;
  Sample sheets;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      const float x = h * static_cast<float>(i);
      const float y = h * static_cast<float>(j);
      sheets.add({x, y, 0.F}, Eigen::Vector3f::UnitZ());
      sheets.add({x + 0.4F * h, y + 0.3F * h, 1.8F * h}, Eigen::Vector3f::UnitZ());
    }
  }
  const Automatic result = automatic(sheets);
  EXPECT_GT(result.report.planes, 5000U);
  // At the rim the other sheet is nearer than a sixth neighbour.
  for (std::size_t i = 0; i < sheets.normals.size(); ++i) {
    const Eigen::Vector3f& p = sheets.points[i].getVector3fMap();
    const float rim = std::min({p.x(), p.y(), 59 * h - p.x(), 59 * h - p.y()});
    if (rim < 2 * h) continue;
    EXPECT_GT(std::abs(result.normals[4 * i + 2]), 0.99999F) << i;
  }
}

TEST(AutomaticNormals, ReportsWhatWasChosen) {
  const Automatic clean = automatic(cube(10000, 3));
  EXPECT_TRUE(clean.report.triangulated);
  EXPECT_GT(clean.report.at_edges, 500U);
  EXPECT_GT(clean.report.planes, 200U);
  EXPECT_LT(clean.report.planes, clean.report.at_edges);
  ASSERT_EQ(clean.report.surfaces.size(), 1U);
  EXPECT_EQ(clean.report.surfaces[0].first, 10);
  EXPECT_EQ(clean.report.surfaces[0].second + clean.report.at_edges, 10000U);
  const Automatic noisy = automatic(torus(10000, 3, 0.4F * torusSpacing(10000)));
  EXPECT_FALSE(noisy.report.triangulated);
  EXPECT_EQ(noisy.report.surfaces[0].first, kMostAutomaticNeighbors);
  EXPECT_GT(noisy.report.surfaces[0].second, 5000U);
  EXPECT_EQ(noisy.report.planes, 0U);
  EXPECT_NE(noisy.report.text().find("64 neighbours"), std::string::npos);
}

// Every choice depends on residuals.
TEST(AutomaticNormals, SameForAnyThreadsAndInstructionSet) {
  for (const Sample& sample : {torus(5000, 4, 0.2F * torusSpacing(5000)), torus(5000, 4),
                               torus(400, 7), cube(5000, 4), noisyCube(5000, 0.13F)}) {
    const Neighborhoods table = neighborsOf(sample.view(), 40);
    std::vector<float> one(4 * sample.normals.size());
    estimateNormalsAutomatically(sample.view(), table, 1, one.data());
    std::vector<float> other(one.size());
    estimateNormalsAutomatically(sample.view(), table, 4, other.data());
    EXPECT_EQ(one, other);
    for (const char* instruction_set : {"avx2", "sse2"}) {
      setenv("SEGORIENT_SIMD", instruction_set, 1);
      estimateNormalsAutomatically(sample.view(), table, 0, other.data());
      unsetenv("SEGORIENT_SIMD");
      EXPECT_EQ(one, other) << instruction_set;
    }
  }
}

// The nearest six of scan lines are on one line, which has no plane.
TEST(AutomaticNormals, ScanLines) {
  Sample lines;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 80; ++j) {
      lines.add({static_cast<float>(j), 4.F * static_cast<float>(i), 0.F},
                Eigen::Vector3f::UnitZ());
    }
  }
  const Automatic result = automatic(lines);
  EXPECT_EQ(result.report.undefined, 0U);
  for (std::size_t i = 0; i < lines.normals.size(); ++i) {
    ASSERT_NEAR(std::abs(result.normals[4 * i + 2]), 1.F, 1e-5F) << i;
  }
}

// A cylinder seen by 20 lines around it, whose 500 points scatter across them.
Sample cylinderByLines(float apart, float scatter) {
  Sample sample;
  std::mt19937 rng(8);
  std::uniform_real_distribution<float> shift(-scatter, scatter);
  for (int line = 0; line < 20; ++line) {
    for (int i = 0; i < 500; ++i) {
      const float angle =
          6.2831853F * (static_cast<float>(i) + 0.1F * static_cast<float>(line)) / 500.F;
      const Eigen::Vector3f out{std::cos(angle), std::sin(angle), 0.F};
      sample.add({out.x(), out.y(), apart * static_cast<float>(line) + shift(rng)}, out);
    }
  }
  return sample;
}

// The bend along a line turns planes and triangles of few neighbours that are all of it. Points are
// .0126 apart.
TEST(AutomaticNormals, NeighborsOfOneLineTellNoNormal) {
  for (const auto& [apart, scatter] :
       {std::pair{0.15F, 0.001F}, std::pair{0.1F, 0.F}, std::pair{0.08F, 0.0003F}}) {
    const Sample sample = cylinderByLines(apart, scatter);
    for (const int k : {12, 32}) {
      const Automatic found = automaticWithIndex(sample, k);
      EXPECT_TRUE(found.report.traits.lines) << apart;
      EXPECT_LT(rmsDegrees(sample, found.normals), 1.0) << apart << " " << k;
    }
  }
  EXPECT_FALSE(automatic(torus(6000, 6)).report.traits.lines);
}

// A torus of radii 1 and .4 by contours at 21 heights, .038 apart, along which the points of each
// are at random.
Sample torusByContours() {
  Sample sample;
  std::mt19937 rng(4);
  std::uniform_real_distribution<float> around(0.F, 6.2831853F);
  for (int line = 0; line < 21; ++line) {
    const float z = 0.038F * static_cast<float>(line - 10);
    for (const float side : {-1.F, 1.F}) {
      const float across = side * std::sqrt(0.16F - z * z);
      for (int i = 0; i < 600; ++i) {
        const float angle = around(rng);
        const Eigen::Vector3f radial{std::cos(angle), std::sin(angle), 0.F};
        Eigen::Vector3f p = (1.F + across) * radial;
        p.z() = z;
        sample.add(p, (p - radial) / 0.4F);
      }
    }
  }
  return sample;
}

// A quadratic surface through points of two lines may lean any way between them, and a plane
// through the points of a bent contour is the contour's.
TEST(AutomaticNormals, NeighborsOfTwoContoursTellNoSlope) {
  const Sample sample = torusByContours();
  for (const int k : {12, 32}) {
    const Automatic found = automaticWithIndex(sample, k);
    EXPECT_TRUE(found.report.traits.lines);
    EXPECT_GT(found.report.across, sample.normals.size() / 10) << k;
    EXPECT_LT(rmsDegrees(sample, found.normals), 3.0) << k;
  }
}

TEST(AutomaticNormals, SeekMoreNeighborsWhereTheNoiseAsks) {
  for (const float noise : {0.F, 0.4F}) {
    const Sample sample = torus(6000, 6, noise * torusSpacing(6000));
    const Automatic found = automaticWithIndex(sample, 8);
    EXPECT_EQ(found.report.surfaces[0].first, noise > 0.F ? kMostAutomaticNeighbors : 10);
    EXPECT_EQ(found.report.analytic, noise == 0.F);
    EXPECT_EQ(found.normals, automatic(sample).normals);
  }
}

// Where noise asks for more neighbours than there are in the table, no table of all is made.
TEST(AutomaticNormals, PartByPartTheSameAtOnce) {
  for (const float noise : {0.13F, 0.2F, 0.3F, 0.7F}) {
    const Sample sample = noisyCube(9000, noise);
    std::vector<pcl::index_t> unexplained_at_once;
    Automatic at_once;
    at_once.normals.resize(4 * sample.normals.size());
    at_once.report = estimateNormalsAutomatically(
        sample.view(), neighborsOf(sample.view(), kMostAutomaticNeighbors), 0,
        at_once.normals.data(), &unexplained_at_once);
    // Beyond, no cubic surfaces are tried.
    ASSERT_EQ(at_once.report.traits.noise.in_spacings > 0.35, noise > 0.5F);
    search::MedianHashIndex index;
    index.build(sample.view(), nullptr, {});
    std::vector<float> found(4 * sample.normals.size());
    std::vector<pcl::index_t> unexplained;
    const AutomaticNormalReport report = estimateNormalsAutomatically(
        sample.view(), index, neighborsOf(sample.view(), 32), 0, found.data(), &unexplained);
    EXPECT_EQ(report.text(), at_once.report.text());
    EXPECT_EQ(found, at_once.normals);
    EXPECT_FALSE(unexplained.empty());
    EXPECT_EQ(unexplained, unexplained_at_once);

    // Some rows only: the others keep what they have.
    std::vector<pcl::index_t> some;
    for (pcl::index_t i = 0; i < 9000; i += 7) some.push_back(i);
    std::vector<float> of_some(found.size(), 5.F);
    estimateNormalsAutomatically(sample.view(), index, neighborsOf(sample.view(), 32), 0,
                                 of_some.data(), nullptr, &some, &report.traits);
    for (std::size_t i = 0; i < 9000; ++i) {
      for (std::size_t a = 0; a < 4; ++a) {
        ASSERT_EQ(of_some[4 * i + a], i % 7 == 0 ? found[4 * i + a] : 5.F) << i;
      }
    }
  }
}

TEST(AutomaticNormals, SmallAndDegenerateClouds) {
  for (const std::size_t count : {0U, 1U, 2U, 3U, 7U, 20U}) {
    Sample sample = torus(count, 5);
    std::vector<float> normals(4 * count);
    const Neighborhoods table =
        neighborsOf({count > 0 ? &sample.points[0].x : nullptr, 4, count}, kMostAutomaticNeighbors);
    const AutomaticNormalReport report = estimateNormalsAutomatically(
        {count > 0 ? &sample.points[0].x : nullptr, 4, count}, table, 0, normals.data());
    EXPECT_EQ(report.undefined, count < 3 ? count : 0U) << count;
  }
  Sample line;
  for (int i = 0; i < 50; ++i) {
    line.add({static_cast<float>(i), 0.F, 0.F}, Eigen::Vector3f::UnitZ());
  }
  EXPECT_EQ(automatic(line).report.undefined, 50U);
}

}  // namespace
}  // namespace segorient::test
