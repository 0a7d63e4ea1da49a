// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <segorient/features/normal_recomputation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "feature_clouds.h"
#include "features/local_normals.h"
#include "features/recompute_normals.h"

namespace segorient::test {
namespace {

/// A segmented cloud with plane normals, averaged across edges.
struct Segmented {
  Sample sample;
  Neighborhoods table;
  std::vector<std::int32_t> labels;
  std::vector<std::int32_t> truth;
  std::vector<std::uint8_t> regular;
  std::vector<float> normals;

  void estimate() {
    table = neighborsOf(sample.view(), 20);
    LocalNormalOptions options;
    options.k = 12;
    normals.resize(4 * sample.normals.size());
    estimateNormals(sample.view(), table, options, normals.data());
  }
  RecomputationReport recompute(const RecomputationOptions& options, int rounds) {
    RecomputationReport report;
    for (int r = 0; r < rounds; ++r) {
      report = recomputeNormals(sample.view(), table, regular, options, labels, normals);
    }
    return report;
  }
  bool nearEdge(std::size_t i) const {
    for (int j = 0; j < 11; ++j) {
      const auto q = static_cast<std::size_t>(table.indices(i)[j]);
      if (std::abs(sample.normals[i].dot(sample.normals[q])) < 0.8F) return true;
    }
    return false;
  }
  /// Share of points near edges whose normal is within ten degrees.
  double sharpness() const {
    std::size_t near = 0;
    std::size_t good = 0;
    for (std::size_t i = 0; i < sample.normals.size(); ++i) {
      if (!nearEdge(i)) continue;
      ++near;
      good += angleBetween(sample.normals[i], &normals[4 * i]) < 10 * kDegree;
    }
    return static_cast<double>(good) / static_cast<double>(near);
  }
  double labelAccuracy() const {
    std::size_t right = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) right += labels[i] == truth[i];
    return static_cast<double>(right) / static_cast<double>(labels.size());
  }
};

/// A cube cut into segments by its averaged normals, as growing would: the labels of some points
/// near edges are those of the face beyond, and where the normal lies between two faces the point
/// is in a small segment.
Segmented segmentedCube(std::size_t count, unsigned seed, float noise) {
  Segmented s;
  s.sample = cube(count, seed);
  std::mt19937 generator(seed);
  std::normal_distribution<float> gauss(0.F, 1.F);
  for (std::size_t i = 0; i < count; ++i) {
    s.truth.push_back(static_cast<std::int32_t>(i % 6));
    for (int a = 0; noise > 0.F && a < 3; ++a)
      s.sample.points[i].data[a] += noise * gauss(generator);
  }
  s.estimate();
  s.regular.assign(7, 1);
  s.regular[6] = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Index axis = 0;
    const Eigen::Map<const Eigen::Vector3f> n(&s.normals[4 * i]);
    const float largest = n.cwiseAbs().maxCoeff(&axis);
    const bool low = s.sample.points[i].data[axis] < 0.F;
    s.labels.push_back(largest < 0.85F ? 6 : static_cast<std::int32_t>(axis) + (low ? 3 : 0));
  }
  return s;
}

/// A torus cut into eight segments along smooth borders.
Segmented segmentedTorus(std::size_t count, unsigned seed, float noise) {
  Segmented s;
  s.sample = torus(count, seed, noise);
  s.estimate();
  for (const auto& p : s.sample.points) {
    s.labels.push_back((p.x > 0 ? 1 : 0) + (p.y > 0 ? 2 : 0) + (p.z > 0 ? 4 : 0));
  }
  s.truth = s.labels;
  s.regular.assign(8, 1);
  return s;
}

TEST(OneSidedRule, SharpensACube) {
  for (const unsigned seed : {1U, 2U}) {
    Segmented s = segmentedCube(12000, seed, 0.F);
    EXPECT_LT(s.sharpness(), 0.5);
    EXPECT_LT(s.labelAccuracy(), 0.98);
    const RecomputationReport report = s.recompute({}, 2);
    EXPECT_GT(report.recomputed, 1000U);
    EXPECT_GT(s.sharpness(), 0.98);
    EXPECT_GT(s.labelAccuracy(), 0.99);
  }
}

TEST(OneSidedRule, SharpensANoisyCube) {
  const float spacing = std::sqrt(24.F / 12000.F);  // mean distance between points
  Segmented s = segmentedCube(12000, 3, 0.1F * spacing);
  s.recompute({}, 2);
  EXPECT_GT(s.sharpness(), 0.93);
  EXPECT_GT(s.labelAccuracy(), 0.985);
  Segmented noisy = segmentedCube(12000, 3, 0.25F * spacing);
  noisy.recompute({}, 2);
  EXPECT_GT(noisy.sharpness(), 0.8);
  EXPECT_GT(noisy.labelAccuracy(), 0.96);
}

TEST(OneSidedRule, LeavesSmoothCloudsAlone) {
  for (const float noise : {0.F, 0.1F, 0.25F}) {
    Segmented s = segmentedTorus(12000, 4, noise * torusSpacing(12000));
    const double before = rmsDegrees(s.sample, s.normals);
    const RecomputationReport report = s.recompute({}, 2);
    EXPECT_LE(report.recomputed, 12U);
    EXPECT_LT(rmsDegrees(s.sample, s.normals), 1.01 * before);
  }
}

TEST(OneSidedRule, NewNormalsKeepTheirSide) {
  Segmented s = segmentedCube(6000, 5, 0.F);
  const std::vector<float> old = s.normals;
  s.recompute({}, 1);
  for (std::size_t i = 0; i < s.labels.size(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> a(&old[4 * i]);
    const Eigen::Map<const Eigen::Vector3f> b(&s.normals[4 * i]);
    ASSERT_GE(a.dot(b), 0.F);
    ASSERT_NEAR(b.norm(), 1.F, 1e-5F);
    ASSERT_EQ(s.normals[4 * i + 3], old[4 * i + 3]);
  }
}

TEST(ModifiedNeighborhoods, SharpenACubeAndLeaveATorusAlone) {
  RecomputationOptions options;
  options.rule = RecomputationRule::MODIFIED_NEIGHBORHOODS;
  options.k = 12;
  Segmented s = segmentedCube(12000, 6, 0.F);
  s.labels = s.truth;
  s.recompute(options, 1);
  EXPECT_GT(s.sharpness(), 0.98);
  Segmented smooth = segmentedTorus(12000, 6, 0.F);
  EXPECT_EQ(smooth.recompute(options, 1).recomputed, 0U);
  // Halves of a torus differ in their reference normals although their common border is smooth.
  options.delta_between_references = true;
  EXPECT_GT(smooth.recompute(options, 1).recomputed, 100U);
}

class AnyRule : public testing::TestWithParam<RecomputationRule> {};

TEST_P(AnyRule, SameForAnyThreadsAndOrder) {
  RecomputationOptions options;
  options.rule = GetParam();
  options.threads = 1;
  const Segmented start = segmentedCube(5000, 7, 0.01F);
  Segmented reference = start;
  reference.recompute(options, 2);
  Segmented threaded = start;
  options.threads = 4;
  threaded.recompute(options, 2);
  EXPECT_EQ(threaded.normals, reference.normals);
  EXPECT_EQ(threaded.labels, reference.labels);

  std::vector<std::size_t> order(start.labels.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  Segmented shuffled = start;
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.sample.points[i] = start.sample.points[order[i]];
    shuffled.labels[i] = start.labels[order[i]];
    std::copy_n(&start.normals[4 * order[i]], 4, &shuffled.normals[4 * i]);
  }
  shuffled.table = neighborsOf(shuffled.sample.view(), 20);
  shuffled.recompute(options, 2);
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_EQ(shuffled.labels[i], reference.labels[order[i]]);
    const Eigen::Map<const Eigen::Vector3f> expected(&reference.normals[4 * order[i]]);
    ASSERT_LT(angleBetween(expected, &shuffled.normals[4 * i]), 1e-4);
  }
}

TEST_P(AnyRule, BadInputChangesNothing) {
  RecomputationOptions options;
  options.rule = GetParam();
  Segmented s = segmentedCube(600, 8, 0.F);
  const std::vector<float> normals = s.normals;
  std::vector<std::int32_t> few(5, 0);
  EXPECT_EQ(recomputeNormals(s.sample.view(), s.table, s.regular, options, few, s.normals).examined,
            0U);
  EXPECT_EQ(s.normals, normals);
  s.labels.assign(600, -1);
  EXPECT_EQ(s.recompute(options, 1).recomputed, 0U);
  s.labels.assign(600, 99);  // no such label
  EXPECT_EQ(s.recompute(options, 1).recomputed, 0U);
  EXPECT_EQ(s.normals, normals);
  // Missing normals are no obstacle.
  Segmented gaps = segmentedCube(6000, 8, 0.F);
  for (std::size_t i = 0; i < std::size_t{4} * 6000; i += 40) {
    std::fill_n(&gaps.normals[i], 4, std::numeric_limits<float>::quiet_NaN());
  }
  EXPECT_GT(gaps.recompute(options, 1).recomputed, 100U);
}

INSTANTIATE_TEST_SUITE_P(Rules, AnyRule,
                         testing::Values(RecomputationRule::ONE_SIDED,
                                         RecomputationRule::MODIFIED_NEIGHBORHOODS));

using Recomputation = NormalRecomputation<pcl::PointXYZ, pcl::Normal>;
using Normals = pcl::PointCloud<pcl::Normal>;

Normals cloudOf(const std::vector<float>& normals) {
  Normals cloud(static_cast<std::uint32_t>(normals.size() / 4), 1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::copy_n(&normals[4 * i], 3, cloud[i].normal);
    cloud[i].curvature = normals[4 * i + 3];
  }
  return cloud;
}

TEST(NormalRecomputation, IsTheCoreInRounds) {
  Segmented s = segmentedCube(6000, 9, 0.F);
  Recomputation recomputation;
  recomputation.setInputCloud(s.sample.points.makeShared());
  recomputation.setInputNormals(cloudOf(s.normals).makeShared());
  recomputation.setLabels(s.labels, s.regular);
  recomputation.setNeighborhoods(pcl::make_shared<Neighborhoods>(s.table));
  Normals with_table;
  recomputation.compute(with_table);
  recomputation.setNeighborhoods({});
  Normals searched;  // from the labels that were set, not from those that were moved
  recomputation.compute(searched);
  EXPECT_GT(recomputation.getReport().recomputed, 0U);
  s.recompute({}, recomputation.getNumberOfRounds());
  EXPECT_EQ(recomputation.getLabels(), s.labels);
  EXPECT_EQ(recomputation.getRegular(), s.regular);
  ASSERT_EQ(with_table.size(), 6000U);
  for (std::size_t i = 0; i < 6000; ++i) {
    const Eigen::Map<const Eigen::Vector3f> expected(&s.normals[4 * i]);
    ASSERT_EQ(with_table[i].getNormalVector3fMap(), expected);
    ASSERT_LT(angleBetween(expected, searched[i].normal), 1e-4);
  }
}

TEST(NormalRecomputation, NanDuplicatesAndIndices) {
  Segmented s = segmentedCube(3000, 10, 0.F);
  pcl::PointCloud<pcl::PointXYZ> cloud = s.sample.points;
  cloud += s.sample.points;
  cloud[5].x = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> normals = s.normals;
  normals.insert(normals.end(), s.normals.begin(), s.normals.end());
  std::vector<std::int32_t> labels = s.labels;
  labels.insert(labels.end(), s.labels.begin(), s.labels.end());
  Recomputation recomputation;
  recomputation.setInputCloud(cloud.makeShared());
  recomputation.setInputNormals(cloudOf(normals).makeShared());
  recomputation.setLabels(labels, s.regular);
  Normals out;
  recomputation.compute(out);
  ASSERT_EQ(out.size(), 6000U);
  EXPECT_GT(recomputation.getReport().recomputed, 100U);
  for (std::size_t i = 0; i < 3000; ++i) {
    if (i == 5) continue;
    ASSERT_EQ(out[i].getNormalVector3fMap(), out[i + 3000].getNormalVector3fMap());
  }
  recomputation.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{7, -1, 6000, 7}));
  recomputation.compute(out);
  ASSERT_EQ(out.size(), 4U);
  EXPECT_TRUE(std::isnan(out[1].normal_x) && std::isnan(out[2].normal_x));
  EXPECT_EQ(out[0].normal_x, out[3].normal_x);
  EXPECT_FALSE(out.is_dense);
}

TEST(NormalRecomputation, TheOutputMayBeTheInput) {
  const Segmented s = segmentedCube(3000, 11, 0.F);
  const auto normals = cloudOf(s.normals).makeShared();
  Recomputation recomputation;
  recomputation.setInputCloud(s.sample.points.makeShared());
  recomputation.setInputNormals(normals);
  recomputation.setLabels(s.labels, s.regular);
  Normals elsewhere;
  recomputation.compute(elsewhere);
  recomputation.compute(*normals);
  ASSERT_EQ(normals->size(), 3000U);
  for (std::size_t i = 0; i < 3000; ++i) {
    ASSERT_EQ((*normals)[i].getNormalVector3fMap(), elsewhere[i].getNormalVector3fMap());
  }
}

// With a ready table as without one, points that are not asked for keep their labels.
TEST(NormalRecomputation, IndicesHoldForAReadyTable) {
  const Segmented s = segmentedCube(3000, 12, 0.F);
  const auto half = pcl::make_shared<pcl::Indices>(1500);
  std::iota(half->begin(), half->end(), 0);
  Recomputation recomputation;
  recomputation.setInputCloud(s.sample.points.makeShared());
  recomputation.setInputNormals(cloudOf(s.normals).makeShared());
  recomputation.setLabels(s.labels, s.regular);
  recomputation.setNeighborhoods(pcl::make_shared<Neighborhoods>(s.table));
  Normals out;
  recomputation.setIndices(half);
  recomputation.compute(out);
  EXPECT_EQ(out.size(), 1500U);
  EXPECT_GT(recomputation.getReport().recomputed, 0U);
  EXPECT_LE(recomputation.getReport().examined, 1500U * 2) << "in two rounds";
  EXPECT_TRUE(std::equal(s.labels.begin() + 1500, s.labels.end(),
                         recomputation.getLabels().begin() + 1500));
}

TEST(NormalRecomputation, PointNormalOutputCarriesThePoint) {
  const Segmented s = segmentedCube(600, 13, 0.F);
  pcl::PointCloud<pcl::PointNormal> normals;
  pcl::copyPointCloud(cloudOf(s.normals), normals);
  NormalRecomputation<pcl::PointXYZ, pcl::PointNormal> recomputation;
  recomputation.setInputCloud(s.sample.points.makeShared());
  recomputation.setInputNormals(normals.makeShared());
  recomputation.setLabels(s.labels, s.regular);
  pcl::PointCloud<pcl::PointNormal> out;
  recomputation.compute(out);
  ASSERT_EQ(out.size(), 600U);
  for (std::size_t i = 0; i < 600; ++i) {
    ASSERT_EQ(out[i].getVector3fMap(), s.sample.points[i].getVector3fMap());
  }
}

}  // namespace
}  // namespace segorient::test
