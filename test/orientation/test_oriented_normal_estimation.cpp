// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/search/impl/median_neighbors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "class_clouds.h"

namespace segorient {
namespace {

using Estimation = OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal>;
using test::LabelledCloud;

class Quiet : public testing::Test {
 protected:
  void SetUp() override { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  void TearDown() override { pcl::console::setVerbosityLevel(pcl::console::L_INFO); }
};
using OrientedNormalEstimationTest = Quiet;

LabelledCloud sphere(std::size_t n = 3000) {
  return test::sample("sphere", {test::sphere({0, 0, 0}, 1)}, n, 61);
}

TEST_F(OrientedNormalEstimationTest, NeedsNothingButACloud) {
  const LabelledCloud cloud = sphere();
  Estimation estimation;
  estimation.setInputCloud(test::toPcl(cloud));
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  ASSERT_EQ(normals.size(), cloud.size());
  EXPECT_TRUE(normals.is_dense);
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_TRUE(test::agrees(normals[i], cloud, i));
  EXPECT_EQ(estimation.getLabels().size(), cloud.size());
  EXPECT_EQ(estimation.getConfidences().size(), cloud.size());
  EXPECT_EQ(estimation.getComponents().size(), cloud.size());
  EXPECT_EQ(estimation.getSegments().size(), estimation.getSegmentation().segments.size());
  EXPECT_EQ(estimation.getReport().points, cloud.size());
  EXPECT_EQ(estimation.getReport().components.size(), 1U);
}

TEST_F(OrientedNormalEstimationTest, IsAPclNormalEstimation) {
  const LabelledCloud cloud = sphere();
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal>::Ptr estimation =
      pcl::make_shared<OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal>>();
  estimation->setInputCloud(test::toPcl(cloud));
  estimation->setKSearch(15);
  pcl::PointCloud<pcl::PointNormal> out;
  estimation->compute(out);
  ASSERT_EQ(out.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_TRUE(test::agrees(out[i], cloud, i));
    EXPECT_EQ(out[i].x, cloud.xyz[4 * i]);
    EXPECT_EQ(out[i].z, cloud.xyz[4 * i + 2]);
  }
}

TEST_F(OrientedNormalEstimationTest, KSearchCountsThePointItself) {
  Estimation estimation;
  estimation.setInputCloud(test::toPcl(sphere()));
  estimation.setKSearch(15);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  EXPECT_EQ(estimation.getReport().k, 14);
}

// The radius counts as the k that half of the points have within it.
TEST_F(OrientedNormalEstimationTest, ARadiusIsAScale) {
  const LabelledCloud cloud = sphere();
  const auto points = test::toPcl(cloud);
  const float radius = 0.15F;
  std::vector<int> counts;
  for (const auto& p : *points) {
    int count = -1;
    for (const auto& q : *points) {
      count += (p.getVector3fMap() - q.getVector3fMap()).squaredNorm() < radius * radius ? 1 : 0;
    }
    counts.push_back(count);
  }
  std::nth_element(counts.begin(), counts.begin() + 1500, counts.end());
  Estimation by_radius(2);
  by_radius.setInputCloud(points);
  by_radius.setRadiusSearch(radius);
  pcl::PointCloud<pcl::Normal> normals;
  by_radius.compute(normals);
  ASSERT_EQ(normals.size(), cloud.size());
  EXPECT_NEAR(by_radius.getReport().k, counts[1500], 1);
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_TRUE(test::agrees(normals[i], cloud, i));
  // As many as that, and no more than make sense.
  by_radius.setRadiusSearch(10.0);
  by_radius.compute(normals);
  EXPECT_EQ(by_radius.getReport().k, search::kMostNeighborsWithin);
  by_radius.setRadiusSearch(1e-9);
  by_radius.compute(normals);
  EXPECT_EQ(normals.size(), cloud.size());
  by_radius.setKSearch(10);
  by_radius.compute(normals);
  EXPECT_TRUE(normals.empty()) << "either k or a radius";
}

TEST_F(OrientedNormalEstimationTest, OutputBelongsToTheIndices) {
  const LabelledCloud cloud = sphere();
  Estimation estimation;
  estimation.setInputCloud(test::toPcl(cloud));
  pcl::PointCloud<pcl::Normal> all;
  estimation.compute(all);
  const auto labels = estimation.getLabels();
  const auto indices = pcl::make_shared<pcl::Indices>(
      pcl::Indices{7, 7, 2999, -1, 3000, 0, std::numeric_limits<pcl::index_t>::max()});
  estimation.setIndices(indices);
  pcl::PointCloud<pcl::Normal> some;
  estimation.compute(some);
  ASSERT_EQ(some.size(), indices->size());
  EXPECT_FALSE(some.is_dense);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    const auto row = static_cast<std::size_t>((*indices)[i]);
    EXPECT_EQ(some[i].normal_x, all[row].normal_x);
    EXPECT_EQ(estimation.getLabels()[i], labels[row]);
  }
  for (const std::size_t i : {std::size_t{3}, std::size_t{4}, std::size_t{6}}) {
    EXPECT_TRUE(std::isnan(some[i].normal_x));
    EXPECT_EQ(estimation.getLabels()[i], -1);
  }
}

TEST_F(OrientedNormalEstimationTest, OrientsPointsOnASearchSurface) {
  const LabelledCloud surface = sphere();
  const LabelledCloud few = test::sample("few", {test::sphere({0, 0, 0}, 1)}, 20, 62);
  Estimation estimation;
  estimation.setInputCloud(test::toPcl(few));
  estimation.setSearchSurface(test::toPcl(surface));
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  ASSERT_EQ(normals.size(), few.size());
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_TRUE(test::agrees(normals[i], few, i));
}

TEST_F(OrientedNormalEstimationTest, KeepsTheShapeOfAnOrganizedCloudWithHoles) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(40, 30);
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      const auto x = static_cast<float>(u);
      const auto y = static_cast<float>(v);
      cloud->at(u, v) = pcl::PointXYZ(x, y, 0.01F * x * x);
    }
  }
  cloud->at(5, 5).z = std::numeric_limits<float>::quiet_NaN();
  cloud->is_dense = true;  // it is not: PCL would abort
  Estimation estimation;
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  EXPECT_EQ(normals.width, 40U);
  EXPECT_EQ(normals.height, 30U);
  EXPECT_FALSE(normals.is_dense);
  EXPECT_TRUE(std::isnan(normals.at(5, 5).normal_x));
  const bool up = normals.at(0, 0).normal_z > 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const bool hole = i == 5 * 40 + 5;
    EXPECT_TRUE(hole || (normals[i].normal_z > 0) == up);
  }
}

TEST_F(OrientedNormalEstimationTest, CanBeUsedAgain) {
  Estimation estimation;
  for (const unsigned seed : {1U, 2U}) {
    const LabelledCloud cloud = test::sample("cube", test::cube(), 2000 * seed, seed);
    estimation.setInputCloud(test::toPcl(cloud));
    pcl::PointCloud<pcl::Normal> normals;
    estimation.compute(normals);
    ASSERT_EQ(normals.size(), cloud.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) wrong += !test::agrees(normals[i], cloud, i);
    EXPECT_LE(wrong, cloud.size() / 200);
    EXPECT_EQ(estimation.getReport().points, cloud.size());
  }
}

TEST_F(OrientedNormalEstimationTest, CanBeUsedAfterAnException) {
  Estimation estimation;
  estimation.setInputCloud(test::toPcl(sphere()));
  estimation.setProgress([](const char*, double) { throw std::runtime_error("no more"); });
  pcl::PointCloud<pcl::Normal> normals;
  EXPECT_THROW(estimation.compute(normals), std::runtime_error);
  const LabelledCloud other = test::sample("cube", test::cube(), 500, 3);
  pcl::PointCloud<pcl::Normal> fresh;
  Estimation of_other;
  for (Estimation* e : {&estimation, &of_other}) {
    e->setProgress({});
    e->setInputCloud(test::toPcl(other));
    e->compute(e == &estimation ? normals : fresh);
  }
  ASSERT_EQ(normals.size(), other.size());
  for (std::size_t i = 0; i < other.size(); ++i) {
    EXPECT_EQ(normals[i].getNormalVector3fMap(), fresh[i].getNormalVector3fMap());
  }
}

TEST_F(OrientedNormalEstimationTest, GettersReturnWhatWasSet) {
  Estimation estimation;
  estimation.setMethod(OrientationMethod::BOUNDARY);
  estimation.setNormalEstimator(NormalEstimator::LCT);
  estimation.setSmoothnessThreshold(0.1F);
  estimation.setReferenceThreshold(0.2F);
  estimation.setGamma(0.3F);
  estimation.setReferenceTolerance(0.05F);
  estimation.setNumberOfThreads(3);
  EXPECT_EQ(estimation.getMethod(), OrientationMethod::BOUNDARY);
  EXPECT_EQ(estimation.getNormalEstimator(), NormalEstimator::LCT);
  EXPECT_EQ(estimation.getSmoothnessThreshold(), 0.1F);
  EXPECT_EQ(estimation.getReferenceThreshold(), 0.2F);
  EXPECT_EQ(estimation.getGamma(), 0.3F);
  EXPECT_EQ(estimation.getReferenceTolerance(), 0.05F);
  EXPECT_EQ(estimation.getNumberOfThreads(), 3U);
  EXPECT_EQ(estimation.getOptions().segmentation.beta, 0.2F);
  // AUTO orients by other segments than it returns.
  EXPECT_EQ(estimation.getOptions().orientation.automatic.alpha, 0.1F);
  EXPECT_EQ(estimation.getOptions().orientation.automatic.beta, 0.2F);
  EXPECT_EQ(estimation.getOptions().orientation.automatic.epsilon, 0.05F);
}

}  // namespace
}  // namespace segorient
