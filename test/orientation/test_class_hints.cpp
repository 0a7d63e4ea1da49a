// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What the classes of a PCL pipeline know beforehand reaches the orientation.
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/segment_orientation.h>
#include <segorient/orientation/impl/cloud_hints.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace segorient::test {
namespace {

// The unit square at z = 0, whose side nothing tells.
template <typename PointT = pcl::PointXYZ>
typename pcl::PointCloud<PointT>::Ptr square() {
  std::mt19937 rng(71);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  for (int i = 0; i < 1000; ++i) {
    PointT p;
    p.x = unit(rng);
    p.y = unit(rng);
    p.z = 0.F;
    cloud->push_back(p);
  }
  return cloud;
}

template <typename NormalT>
double up(const pcl::PointCloud<NormalT>& normals) {
  std::size_t count = 0;
  for (const NormalT& n : normals) count += n.normal_z > 0.F ? 1U : 0U;
  return normals.empty() ? -1.0 : static_cast<double>(count) / static_cast<double>(normals.size());
}

template <typename PointT>
double upAfter(OrientedNormalEstimation<PointT, pcl::Normal>& estimation) {
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  return up(normals);
}

pcl::PointCloud<pcl::PointNormal>::Ptr seedPointingDown() {
  auto seeds = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  pcl::PointNormal seed;
  seed.x = seed.y = 0.5F;
  seed.z = 0.F;
  seed.normal_x = seed.normal_y = 0.F;
  seed.normal_z = -1.F;
  seeds->push_back(seed);
  return seeds;
}

TEST(OrientedNormalEstimationHints, ViewpointAndSensorOrigin) {
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  const auto cloud = square();
  estimation.setInputCloud(cloud);
  EXPECT_EQ(upAfter(estimation), 1.0) << "an origin of 0 means that none is known";
  estimation.setViewPoint(0.F, 0.F, -2.F);
  EXPECT_EQ(upAfter(estimation), 0.0);

  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> from_sensor;
  cloud->sensor_origin_ = Eigen::Vector4f(0.F, 0.F, -3.F, 0.F);
  from_sensor.setInputCloud(cloud);
  EXPECT_EQ(upAfter(from_sensor), 0.0);
}

TEST(OrientedNormalEstimationHints, SeedsAndKindOfSurface) {
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(square());
  const auto seeds = seedPointingDown();
  estimation.setSeeds(seeds);
  EXPECT_EQ(estimation.getSeeds(), seeds);
  EXPECT_EQ(upAfter(estimation), 0.0);
  EXPECT_EQ(estimation.getReport().components.at(0).by, DecidedBy::HINTS);
  estimation.setSeeds(nullptr);
  EXPECT_EQ(upAfter(estimation), 1.0);
  EXPECT_EQ(estimation.getSurfaceKind(), SurfaceKind::UNKNOWN);
  estimation.setSurfaceKind(SurfaceKind::OPEN);
  EXPECT_EQ(estimation.getSurfaceKind(), SurfaceKind::OPEN);
}

TEST(OrientedNormalEstimationHints, NormalsThatTheInputHas) {
  const auto cloud = square<pcl::PointNormal>();
  for (pcl::PointNormal& p : *cloud) p.normal_z = -1.F;
  OrientedNormalEstimation<pcl::PointNormal, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  EXPECT_FALSE(estimation.getKeepOrientation());
  EXPECT_EQ(upAfter(estimation), 1.0);
  estimation.setKeepOrientation(true);
  EXPECT_TRUE(estimation.getKeepOrientation());
  EXPECT_EQ(upAfter(estimation), 0.0);
}

TEST(CloudHints, PointsThatSayWhereTheyWereSeenFrom) {
  pcl::PointCloud<pcl::PointWithViewpoint> cloud;
  pcl::PointWithViewpoint p;
  p.vp_x = 1.F;
  p.vp_y = 2.F;
  p.vp_z = 3.F;
  cloud.push_back(p);
  OrientationHints hints;
  detail::addViewpoints(cloud, hints);
  EXPECT_EQ(hints.viewpoints, (std::vector<float>{1.F, 2.F, 3.F}));
  detail::addNormals(cloud, hints);
  EXPECT_TRUE(hints.normals.empty()) << "this type has none";
}

TEST(SegmentOrientationHints, ViewpointSeedsAndSignsOfTheInput) {
  using Orientation = SegmentOrientation<pcl::PointXYZ, pcl::Normal>;
  const auto cloud = square();
  auto normals = pcl::make_shared<pcl::PointCloud<pcl::Normal>>();
  for (std::size_t i = 0; i < cloud->size(); ++i) normals->push_back({0.F, 0.F, -1.F});
  const auto upWith = [&](auto&& set) {
    Orientation orientation;
    orientation.setInputCloud(cloud);
    orientation.setInputNormals(normals);
    set(orientation);
    pcl::PointCloud<pcl::Normal> oriented;
    orientation.compute(oriented);
    return up(oriented);
  };
  EXPECT_EQ(upWith([](Orientation&) {}), 1.0);
  EXPECT_EQ(upWith([](Orientation& o) { o.setViewPoint(0.F, 0.F, -1.F); }), 0.0);
  EXPECT_EQ(upWith([](Orientation& o) { o.setSeeds(seedPointingDown()); }), 0.0);
  EXPECT_EQ(upWith([](Orientation& o) { o.setKeepOrientation(true); }), 0.0);
}

TEST(SegmentOrientationHints, GettersReturnWhatWasSet) {
  SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
  float x = 0.F;
  float y = 0.F;
  float z = 0.F;
  orientation.getViewPoint(x, y, z);
  EXPECT_TRUE(std::isnan(x) && std::isnan(y) && std::isnan(z));
  orientation.setViewPoint(1.F, 2.F, 3.F);
  orientation.getViewPoint(x, y, z);
  EXPECT_TRUE(x == 1.F && y == 2.F && z == 3.F);
  orientation.setSurfaceKind(SurfaceKind::CLOSED);
  EXPECT_EQ(orientation.getSurfaceKind(), SurfaceKind::CLOSED);
  EXPECT_FALSE(orientation.getKeepOrientation());
  EXPECT_EQ(orientation.getSeeds(), nullptr);
}

}  // namespace
}  // namespace segorient::test
