// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Sensors infinitely far away, scans and grids: from the classes to the result.
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/orientation/pipeline.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

namespace segorient::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Two unit squares, at z = 0 and z = 5, 800 points each.
std::vector<float> twoSquares() {
  std::mt19937 rng(61);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> xyz;
  for (int i = 0; i < 1600; ++i) {
    const bool second = i >= 800;  // higher, and beside the first: it hides nothing
    for (const float v : {unit(rng) + (second ? 2.F : 0.F), unit(rng), second ? 5.F : 0.F}) {
      xyz.push_back(v);
    }
  }
  return xyz;
}

double up(const std::vector<float>& xyz, const OrientationHints& hints, std::size_t first,
          std::size_t last) {
  PipelineOptions options;
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  const OrientedCloud cloud = orientCloud({xyz.data(), 3, xyz.size() / 3}, nullptr, options);
  double count = 0.0;
  for (std::size_t i = first; i < last; ++i) count += cloud.normals[4 * i + 2] > 0.F ? 1.0 : 0.0;
  return count / static_cast<double>(last - first);
}

TEST(DirectionHint, DecidesForAllPointsWhateverItsLength) {
  const std::vector<float> xyz = twoSquares();
  for (const float length : {1e-30F, 1.F, 1e30F}) {
    OrientationHints hints;
    hints.has_direction = true;
    hints.direction = {0.F, 0.F, -length};
    EXPECT_EQ(up(xyz, hints, 0, 1600), 0.0) << length;
    hints.direction = {0.F, 0.F, length};
    EXPECT_EQ(up(xyz, hints, 0, 1600), 1.0) << length;
  }
}

TEST(DirectionHint, ComesAfterAPlaceOfThePointsOwn) {
  const std::vector<float> xyz = twoSquares();
  OrientationHints hints;
  hints.has_direction = true;
  hints.viewpoints.assign(xyz.size(), kNaN);
  for (std::size_t i = 0; i < 800; ++i) {
    hints.viewpoints[3 * i] = hints.viewpoints[3 * i + 1] = 0.5F;
    hints.viewpoints[3 * i + 2] = -4.F;
  }
  EXPECT_EQ(up(xyz, hints, 0, 800), 0.0);
  EXPECT_EQ(up(xyz, hints, 800, 1600), 1.0);
}

TEST(DirectionHint, NoDirectionIsNone) {
  const std::vector<float> xyz = twoSquares();
  const double plain = up(xyz, {}, 0, 1600);
  for (const float v : {0.F, kNaN}) {
    OrientationHints hints;
    hints.has_direction = true;
    hints.direction = {v, v, v};
    EXPECT_EQ(up(xyz, hints, 0, 1600), plain);
  }
}

TEST(DirectionHint, IsSetOnTheClass) {
  const std::vector<float> xyz = twoSquares();
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < 800; ++i) {
    cloud->push_back({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
  }
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.setViewDirection(0.F, 0.F, -2.F);
  estimation.setScans(std::vector<std::int32_t>(800, 3));
  EXPECT_EQ(estimation.getScans().size(), 800U);
  estimation.compute(normals);
  for (const pcl::Normal& n : normals) EXPECT_LT(n.normal_z, 0.F);
  estimation.setUp();
  EXPECT_EQ(estimation.getViewDirection()[2], 1.F);
  estimation.compute(normals);
  for (const pcl::Normal& n : normals) EXPECT_GT(n.normal_z, 0.F);
}

}  // namespace
}  // namespace segorient::test
