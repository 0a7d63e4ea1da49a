// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Usual point types and organised clouds through every class: compiled without PCL_NO_PRECOMPILE,
// so that the library has to hold them.
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
#include <cstdint>
#include <limits>
#include <vector>

namespace segorient::test {
namespace {

template <typename PointT>
class PointTypes : public testing::Test {
 protected:
  // An organised cloud of 60 x 40 points of a wavy sheet, two of them NaN.
  static typename pcl::PointCloud<PointT>::Ptr sheet() {
    const typename pcl::PointCloud<PointT>::Ptr cloud(new pcl::PointCloud<PointT>(60, 40));
    for (unsigned y = 0; y < 40; ++y) {
      for (unsigned x = 0; x < 60; ++x) {
        PointT& p = cloud->at(static_cast<int>(x), static_cast<int>(y));
        p.x = 0.1F * static_cast<float>(x);
        p.y = 0.1F * static_cast<float>(y);
        p.z = 0.2F * std::sin(p.x);
      }
    }
    for (const std::size_t bad : {std::size_t{7}, std::size_t{1000}}) {
      (*cloud)[bad].x = std::numeric_limits<float>::quiet_NaN();
    }
    cloud->is_dense = false;
    return cloud;
  }

  static void expectNormals(const pcl::PointCloud<pcl::Normal>& normals) {
    ASSERT_EQ(normals.size(), 2400U);
    EXPECT_EQ(normals.width, 60U);
    EXPECT_EQ(normals.height, 40U);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const bool bad = i == 7 || i == 1000;
      ASSERT_EQ(std::isfinite(normals[i].normal_x), !bad) << i;
      // At the border some estimators have less to go by.
      const std::size_t x = i % 60;
      const std::size_t y = i / 60;
      if (!bad && x > 1 && x < 58 && y > 1 && y < 38) {
        ASSERT_GT(std::abs(normals[i].normal_z), 0.9F) << i;
      }
    }
  }

  template <typename Estimation>
  static void estimate(const typename pcl::PointCloud<PointT>::Ptr& cloud,
                       pcl::PointCloud<pcl::Normal>& normals) {
    Estimation estimation;
    estimation.setInputCloud(cloud);
    estimation.setKSearch(12);
    estimation.compute(normals);
    expectNormals(normals);
  }
};

using Types = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointNormal>;
TYPED_TEST_SUITE(PointTypes, Types, );

TYPED_TEST(PointTypes, GoThroughAllClasses) {
  const auto cloud = this->sheet();
  search::MedianHash<TypeParam> search;
  search.setInputCloud(cloud);
  pcl::Indices indices;
  std::vector<float> distances;
  EXPECT_EQ(search.nearestKSearch((*cloud)[500], 5, indices, distances), 5);
  EXPECT_EQ(indices[0], 500);

  const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  this->template estimate<LCTNormalEstimation<TypeParam, pcl::Normal>>(cloud, *normals);
  this->template estimate<LDTNormalEstimation<TypeParam, pcl::Normal>>(cloud, *normals);
  this->template estimate<AwASNormalEstimation<TypeParam, pcl::Normal>>(cloud, *normals);
  this->template estimate<PlaneNormalEstimation<TypeParam, pcl::Normal>>(cloud, *normals);

  NormalSegmentation<TypeParam, pcl::Normal> segmentation;
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals);
  std::vector<pcl::PointIndices> segments;
  segmentation.extract(segments);
  EXPECT_FALSE(segments.empty());
  EXPECT_EQ(segmentation.getLabels().size(), cloud->size());
  EXPECT_EQ(segmentation.getLabels()[7], -1);

  NormalRecomputation<TypeParam, pcl::Normal> recomputation;
  recomputation.setInputCloud(cloud);
  recomputation.setInputNormals(normals);
  const Segmentation& flat = segmentation.getPlanarSegmentation();
  recomputation.setLabels(flat.labels, std::vector<std::uint8_t>(flat.segments.size(), 1));
  pcl::PointCloud<pcl::Normal> sharper;
  recomputation.compute(sharper);
  this->expectNormals(sharper);

  SegmentOrientation<TypeParam, pcl::Normal> orientation;
  orientation.setInputCloud(cloud);
  orientation.setInputNormals(normals);
  pcl::PointCloud<pcl::Normal> oriented;
  orientation.compute(oriented);
  OrientedNormalEstimation<TypeParam, pcl::Normal> all;
  all.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal> at_once;
  all.compute(at_once);
  this->expectNormals(at_once);
  for (const pcl::PointCloud<pcl::Normal>* result : {&oriented, &at_once}) {
    ASSERT_EQ(result->size(), cloud->size());
    for (std::size_t i = 0; i < result->size(); ++i) {
      if (i == 7 || i == 1000) continue;
      ASSERT_GT((*result)[i].normal_z * (*result)[0].normal_z, 0.F) << i;
    }
  }
}

TEST(OutputTypes, ANormalOutputCarriesThePosition) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  for (int i = 0; i < 400; ++i) {
    cloud->push_back({static_cast<float>(i % 20), static_cast<float>(i / 20), 0.F});
  }
  const pcl::PointCloud<pcl::PointNormal>::Ptr oriented(new pcl::PointCloud<pcl::PointNormal>);
  OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.compute(*oriented);
  ASSERT_EQ(oriented->size(), cloud->size());
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    EXPECT_EQ((*oriented)[i].x, (*cloud)[i].x);
    EXPECT_NEAR((*oriented)[i].normal_z, 1.F, 1e-5F);
  }
  SegmentTriangulation<pcl::PointNormal> triangulation;
  triangulation.setInputCloud(oriented);
  std::vector<pcl::Vertices> triangles;
  triangulation.reconstruct(triangles);
  EXPECT_GT(triangles.size(), 600U);
}

}  // namespace
}  // namespace segorient::test
