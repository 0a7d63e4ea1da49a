// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What version 1.0 called by other names works for one version more, against the shared libraries.
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <segorient/common/export.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <cmath>
#include <vector>

SEGORIENT_DEPRECATED_BEGIN
namespace segorient::test {
namespace {

// Points of a ball with some noise, the same in every run.
std::vector<float> noisyBall() {
  std::vector<float> xyz;
  constexpr int kPoints = 1500;
  for (int i = 0; i < kPoints; ++i) {
    const float z = 1.F - 2.F * (static_cast<float>(i) + 0.5F) / static_cast<float>(kPoints);
    const float turn = 2.3999632F * static_cast<float>(i);
    const float r = 1.F + 0.02F * std::sin(37.F * static_cast<float>(i));
    const float flat = r * std::sqrt(1.F - z * z);
    for (const float v : {flat * std::cos(turn), flat * std::sin(turn), r * z}) xyz.push_back(v);
  }
  return xyz;
}

std::vector<float> normals(const PipelineOptions& options) {
  const std::vector<float> xyz = noisyBall();
  return orientCloud({xyz.data(), 3, xyz.size() / 3}, nullptr, options).normals;
}

TEST(FormerNames, SettersOfAngles) {
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setAlpha(0.1F);
  estimation.setBeta(0.2F);
  estimation.setEpsilon(0.3F);
  EXPECT_EQ(estimation.getSmoothnessThreshold(), 0.1F);
  EXPECT_EQ(estimation.getReferenceThreshold(), 0.2F);
  EXPECT_EQ(estimation.getReferenceTolerance(), 0.3F);
  EXPECT_EQ(estimation.getAlpha(), 0.1F);
  EXPECT_EQ(estimation.getBeta(), 0.2F);
  EXPECT_EQ(estimation.getEpsilon(), 0.3F);
}

TEST(FormerNames, Enumerators) {
  EXPECT_EQ(NormalEstimator::Plane, NormalEstimator::PLANE);
  EXPECT_EQ(NormalEstimator::AwASQuadratic, NormalEstimator::AWAS_QUADRATIC);
  EXPECT_EQ(NormalEstimator::AwASCubic, NormalEstimator::AWAS_CUBIC);
  EXPECT_EQ(NormalEstimator::Automatic, NormalEstimator::AUTO);
  EXPECT_EQ(SegmentKind::Regular, SegmentKind::REGULAR);
  EXPECT_EQ(SegmentKind::Connected, SegmentKind::CONNECTED);
  EXPECT_EQ(SegmentKind::Isolated, SegmentKind::ISOLATED);
  EXPECT_EQ(RecomputationRule::OneSided, RecomputationRule::ONE_SIDED);
  EXPECT_EQ(RecomputationRule::ModifiedNeighborhoods, RecomputationRule::MODIFIED_NEIGHBORHOODS);
}

TEST(FormerNames, SensorsInWords) {
  EXPECT_STREQ(sensorKindName(SensorKind::CAMERA), toString(SensorKind::CAMERA));
  EXPECT_STREQ(sensorEvidenceName(SensorEvidence::IMAGE), toString(SensorEvidence::IMAGE));
}

TEST(FormerNames, PlanarSegments) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  auto found = pcl::make_shared<pcl::PointCloud<pcl::Normal>>();
  const std::vector<float> xyz = noisyBall();
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    cloud->emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
    found->emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  }
  NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(found);
  std::vector<pcl::PointIndices> faces;
  segmentation.extract(faces);
  EXPECT_EQ(&segmentation.getSegmentation(), &segmentation.getPlanarSegmentation());
  EXPECT_EQ(segmentation.getSegmentGraph().borders.size(),
            segmentation.getPlanarSegmentGraph().borders.size());
}

TEST(FormerNames, SettingsOfTheDefaultMethod) {
  // Of so few points, the field of all of them would have the last word.
  PipelineOptions neither;
  neither.orientation.automatic.fit_normals = false;
  neither.orientation.automatic.winding_normals = false;
  PipelineOptions now = neither;
  now.orientation.automatic.filter_rounds = 0;
  now.orientation.automatic.split_walls = false;
  PipelineOptions former = neither;
  former.filter_rounds = 0;
  former.sheet_normals.split_walls = false;
  EXPECT_EQ(normals(former), normals(now));
  EXPECT_NE(normals(neither), normals(now));
}

}  // namespace
}  // namespace segorient::test
SEGORIENT_DEPRECATED_END
