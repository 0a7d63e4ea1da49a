// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// MedianHash in place of pcl::search::KdTree in PCL's own classes: equal results, to the last bit.
#include <gtest/gtest.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/registration/icp.h>
#include <pcl/segmentation/region_growing.h>
#include <segorient/search/median_hash.h>

#include <cmath>
#include <random>

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using PclTree = pcl::search::KdTree<pcl::PointXYZ>;
using OurTree = search::MedianHash<pcl::PointXYZ>;

// Up to PCL 1.14 the filter has no setter for its tree; explicit instantiation may name the member.
using Filter = pcl::StatisticalOutlierRemoval<pcl::PointXYZ>;
pcl::search::Search<pcl::PointXYZ>::Ptr& searcherOf(Filter& filter);
template <auto kMember>
struct Reach {
  friend pcl::search::Search<pcl::PointXYZ>::Ptr& searcherOf(Filter& filter) {
    return filter.*kMember;
  }
};
template struct Reach<&Filter::searcher_>;

// Three faces of a box with a few stray points; random, so that no two distances are equal.
Cloud::Ptr boxCorner(std::size_t n, unsigned int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(0.0F, 1.0F);
  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < n; ++i) {
    const float a = u(random);
    const float b = u(random);
    const float noise = 0.002F * u(random);
    if (i % 50 == 49) {
      cloud->push_back({u(random) * 2.0F, u(random) * 2.0F, u(random) * 2.0F});
    } else if (i % 3 == 0) {
      cloud->push_back({a, b, noise});
    } else if (i % 3 == 1) {
      cloud->push_back({a, noise, b});
    } else {
      cloud->push_back({noise, a, b});
    }
  }
  return cloud;
}

template <typename Tree>
Normals::Ptr normals(const Cloud::Ptr& cloud, int k, double radius) {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(2);
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::make_shared<Tree>());
  estimation.setKSearch(k);
  estimation.setRadiusSearch(radius);
  auto result = pcl::make_shared<Normals>();
  estimation.compute(*result);
  return result;
}

// Equal, or both not a number, which is what a point with too few neighbours gets.
bool same(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void expectEqual(const Normals& a, const Normals& b) {
  ASSERT_EQ(a.size(), b.size());
  std::size_t valid = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int j = 0; j < 3; ++j) ASSERT_PRED2(same, a[i].normal[j], b[i].normal[j]) << "point " << i;
    ASSERT_PRED2(same, a[i].curvature, b[i].curvature);
    if (!std::isnan(a[i].curvature)) ++valid;
  }
  EXPECT_GT(valid, a.size() * 9 / 10);
}

TEST(DropIn, NormalEstimationOMP) {
  const auto cloud = boxCorner(6000, 1);
  expectEqual(*normals<PclTree>(cloud, 15, 0.0), *normals<OurTree>(cloud, 15, 0.0));
  expectEqual(*normals<PclTree>(cloud, 0, 0.3), *normals<OurTree>(cloud, 0, 0.3));
}

template <typename Tree>
std::vector<pcl::PointIndices> regions(const Cloud::Ptr& cloud) {
  pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal> growing;
  growing.setInputCloud(cloud);
  growing.setInputNormals(normals<PclTree>(cloud, 15, 0.0));
  growing.setSearchMethod(pcl::make_shared<Tree>());
  growing.setNumberOfNeighbours(12);
  growing.setSmoothnessThreshold(0.1F);
  growing.setMinClusterSize(20);
  std::vector<pcl::PointIndices> clusters;
  growing.extract(clusters);
  return clusters;
}

TEST(DropIn, RegionGrowing) {
  const auto cloud = boxCorner(6000, 2);
  const auto expected = regions<PclTree>(cloud);
  const auto found = regions<OurTree>(cloud);
  ASSERT_GE(expected.size(), 3U);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].indices, expected[i].indices);
}

Cloud filtered(const Cloud::Ptr& cloud, const pcl::search::Search<pcl::PointXYZ>::Ptr& tree) {
  Filter filter;
  searcherOf(filter) = tree;
  filter.setInputCloud(cloud);
  filter.setMeanK(12);
  filter.setStddevMulThresh(1.0);
  Cloud out;
  filter.filter(out);
  return out;
}

TEST(DropIn, StatisticalOutlierRemoval) {
  const auto cloud = boxCorner(6000, 3);
  const Cloud expected = filtered(cloud, pcl::make_shared<PclTree>());
  const Cloud found = filtered(cloud, pcl::make_shared<OurTree>());
  ASSERT_LT(expected.size(), cloud->size());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].getVector3fMap(), expected[i].getVector3fMap());
  }
}

template <typename Tree>
Eigen::Matrix4f registration(const Cloud::Ptr& source, const Cloud::Ptr& target) {
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setSearchMethodTarget(pcl::make_shared<Tree>());
  icp.setSearchMethodSource(pcl::make_shared<Tree>());
  icp.setUseReciprocalCorrespondences(true);
  icp.setMaximumIterations(20);
  Cloud aligned;
  icp.align(aligned);
  EXPECT_TRUE(icp.hasConverged());
  return icp.getFinalTransformation();
}

TEST(DropIn, IterativeClosestPoint) {
  const auto target = boxCorner(4000, 4);
  const auto source = pcl::make_shared<Cloud>();
  const Eigen::Affine3f motion = Eigen::Translation3f(0.02F, -0.01F, 0.015F) *
                                 Eigen::AngleAxisf(0.03F, Eigen::Vector3f(1, 2, 3).normalized());
  pcl::transformPointCloud(*target, *source, motion);
  const Eigen::Matrix4f expected = registration<PclTree>(source, target);
  EXPECT_EQ(registration<OurTree>(source, target), expected);
  EXPECT_LT((expected * motion.matrix() - Eigen::Matrix4f::Identity()).norm(), 1e-3F);
}

}  // namespace
}  // namespace segorient::test
