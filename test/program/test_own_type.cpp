// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// A user's own point type through every class: with PCL_NO_PRECOMPILE, templates are compiled here.
#define PCL_NO_PRECOMPILE
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <segorient/features/awas_normal_estimation.h>
#include <segorient/features/lct_normal_estimation.h>
#include <segorient/features/ldt_normal_estimation.h>
#include <segorient/features/normal_recomputation.h>
#include <segorient/features/plane_normal_estimation.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/segment_orientation.h>
#include <segorient/search/median_hash.h>
#include <segorient/segmentation/normal_segmentation.h>
#include <segorient/surface/segment_triangulation.h>

#include <cmath>
#include <random>
#include <vector>

struct OwnPoint {
  PCL_ADD_POINT4D;
  PCL_ADD_NORMAL4D;
  float curvature;
  float time;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(
    OwnPoint,
    (float, x, x)(float, y, y)(float, z, z)(float, normal_x, normal_x)(float, normal_y, normal_y)(
        float, normal_z, normal_z)(float, curvature, curvature)(float, time, time))

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<OwnPoint>;

// Random points on the unit cube's faces.
Cloud::Ptr cube() {
  std::mt19937 rng(91);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  const Cloud::Ptr cloud(new Cloud);
  for (int i = 0; i < 3000; ++i) {
    float c[3] = {unit(rng), unit(rng), unit(rng)};
    c[i % 3] = static_cast<float>(i / 3 % 2);
    OwnPoint p{};
    p.x = c[0];
    p.y = c[1];
    p.z = c[2];
    p.time = static_cast<float>(i);
    cloud->push_back(p);
  }
  return cloud;
}

double outward(const Cloud& cloud) {
  int right = 0;
  for (const OwnPoint& p : cloud) {
    const float d =
        p.normal_x * (p.x - 0.5F) + p.normal_y * (p.y - 0.5F) + p.normal_z * (p.z - 0.5F);
    right += d > 0.F ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(cloud.size());
}

template <typename Estimation>
void expectUnitNormals(const Cloud::Ptr& cloud, Cloud& normals) {
  Estimation estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::make_shared<search::MedianHash<OwnPoint>>());
  estimation.setKSearch(13);
  estimation.compute(normals);
  ASSERT_EQ(normals.size(), cloud->size());
  for (const OwnPoint& p : normals) {
    ASSERT_NEAR(std::hypot(p.normal_x, std::hypot(p.normal_y, p.normal_z)), 1.F, 1e-4F);
  }
}

TEST(OwnType, GoesThroughAllClasses) {
  const Cloud::Ptr cloud = cube();
  const Cloud::Ptr normals(new Cloud);
  expectUnitNormals<LCTNormalEstimation<OwnPoint, OwnPoint>>(cloud, *normals);
  expectUnitNormals<LDTNormalEstimation<OwnPoint, OwnPoint>>(cloud, *normals);
  expectUnitNormals<AwASNormalEstimation<OwnPoint, OwnPoint>>(cloud, *normals);
  expectUnitNormals<PlaneNormalEstimation<OwnPoint, OwnPoint>>(cloud, *normals);

  NormalSegmentation<OwnPoint, OwnPoint> segmentation;
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals);
  std::vector<pcl::PointIndices> faces;
  segmentation.extract(faces);
  EXPECT_GE(faces.size(), 6U);

  NormalRecomputation<OwnPoint, OwnPoint> recomputation;
  recomputation.setInputCloud(cloud);
  recomputation.setInputNormals(normals);
  std::vector<std::uint8_t> regular;
  for (const Segment& s : segmentation.getPlanarSegmentation().segments) {
    regular.push_back(s.kind == SegmentKind::REGULAR ? 1 : 0);
  }
  recomputation.setLabels(segmentation.getPlanarSegmentation().labels, regular);
  const Cloud::Ptr sharper(new Cloud);
  recomputation.compute(*sharper);
  ASSERT_EQ(sharper->size(), cloud->size());

  SegmentOrientation<OwnPoint, OwnPoint> orientation;
  orientation.setInputCloud(cloud);
  orientation.setInputNormals(sharper);
  Cloud oriented;
  orientation.compute(oriented);
  ASSERT_EQ(oriented.size(), cloud->size());
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    oriented[i].getVector4fMap() = (*cloud)[i].getVector4fMap();
  }
  EXPECT_GE(outward(oriented), 0.998);

  OrientedNormalEstimation<OwnPoint, OwnPoint> estimation;
  estimation.setInputCloud(cloud);
  const Cloud::Ptr at_once(new Cloud);
  estimation.compute(*at_once);
  EXPECT_EQ(outward(*at_once), 1.0);

  SegmentTriangulation<OwnPoint> triangulation;
  triangulation.setInputCloud(at_once);
  std::vector<pcl::Vertices> triangles;
  triangulation.reconstruct(triangles);
  EXPECT_GT(triangles.size(), 4500U) << "nearly two triangles a point";
}

}  // namespace
}  // namespace segorient::test
