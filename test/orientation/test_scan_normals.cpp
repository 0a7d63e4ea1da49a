// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Normals of scans whose noise only many neighbours show, against PCL's planes of 30.
#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <segorient/orientation/first_stages.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "features/sheet_normals.h"
#include "sensor_scans.h"

namespace segorient {
namespace {

constexpr Vector kEye{1.0, 2.3, 1.4};

// What a depth camera sees that tells disparities to an eighth of a pixel: depth goes by steps,
// which grow with its square.
std::vector<float> stepsOfDepth() {
  Scan scan = viewFrom(kEye, -0.35);
  std::vector<float> rows;
  for (std::size_t i = 0; i < scan.view().size; ++i) {
    const float* p = scan.view()[i];
    if (!std::isfinite(p[0])) continue;
    const double depth = (static_cast<double>(p[0]) - kEye[0]) * std::cos(-0.35) +
                         (static_cast<double>(p[1]) - kEye[1]) * std::sin(-0.35);
    const double stepped = 100.0 / std::round(100.0 / depth);
    for (std::size_t a = 0; a < 3; ++a) {
      rows.push_back(
          static_cast<float>(kEye[a] + (static_cast<double>(p[a]) - kEye[a]) * stepped / depth));
    }
  }
  return rows;
}

// Beams of a spinning scanner, four degrees apart, each with a point every fifth of a degree.
std::vector<float> rings() {
  Scan scan;
  for (double e = -36.0; e <= 36.0; e += 4.0) {
    for (double a = 0.05; a < 360.0; a += 0.2) {
      const double c = std::cos(e * kPi / 180.0);
      scan.add({3.0, 2.2, 1.4}, {c * std::cos(a * kPi / 180.0), c * std::sin(a * kPi / 180.0),
                                 std::sin(e * kPi / 180.0)});
    }
  }
  return scan.rows();
}

// Share of normals within 30 degrees of the wall that a point is on; edges are left out.
double shareRight(const std::vector<float>& rows, const std::vector<float>& normals) {
  const Room room;
  std::size_t judged = 0;
  std::size_t right = 0;
  for (std::size_t i = 0; i < rows.size() / 3; ++i) {
    std::array<double, 3> off{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto v = static_cast<double>(rows[3 * i + a]);
      off[a] = std::min(std::fabs(v), std::fabs(v - room.size[a]));
    }
    const std::size_t wall =
        static_cast<std::size_t>(std::min_element(off.begin(), off.end()) - off.begin());
    off[wall] = 1e9;
    const bool at_cupboard = rows[3 * i] > 4.0F && rows[3 * i + 1] < 1.5F && rows[3 * i + 2] < 2.5F;
    if (*std::min_element(off.begin(), off.end()) < 0.4 || at_cupboard) continue;
    ++judged;
    right += std::fabs(normals[4 * i + wall]) > 0.866F ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(judged);
}

std::vector<float> planesOfPcl(const std::vector<float>& rows) {
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    cloud->push_back({rows[i], rows[i + 1], rows[i + 2]});
  }
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(30);
  pcl::PointCloud<pcl::Normal> found;
  estimation.compute(found);
  std::vector<float> out;
  for (const pcl::Normal& n : found) {
    out.insert(out.end(), {n.normal_x, n.normal_y, n.normal_z, n.curvature});
  }
  return out;
}

class NormalsOfScans : public testing::TestWithParam<std::vector<float> (*)()> {};

TEST_P(NormalsOfScans, AreAsRightAsPlanesOfThirty) {
  const std::vector<float> rows = GetParam()();
  const PointView points{rows.data(), 3, rows.size() / 3};
  // Where that is right nearly everywhere, a point in a hundred may be an edge that it does not
  // see.
  const double peer = std::min(0.99, shareRight(rows, planesOfPcl(rows)));
  const PipelineOptions options;
  FirstStages stages(points, options);
  stages.findNormals();
  EXPECT_GE(shareRight(rows, stages.normals()), peer) << "normals";
  EXPECT_GE(shareRight(rows, orientCloud(points, nullptr, {}).normals), peer) << "orient";
}

INSTANTIATE_TEST_SUITE_P(Scans, NormalsOfScans, testing::Values(stepsOfDepth, rings));

TEST(SheetTraits, OnlyManyShowTheNoiseOfSteps) {
  SheetTraits traits;
  traits.noise.fine = 0.1F;
  traits.noise.coarse = 0.25F;
  EXPECT_FALSE(traits.onlyManyShowNoise()) << "an even cloud is curved";
  traits.scan_scales = true;
  EXPECT_TRUE(traits.onlyManyShowNoise());
  traits.noise.coarse = 0.15F;
  EXPECT_FALSE(traits.onlyManyShowNoise());
  traits.noise = {0.F, 0.03F, false};
  EXPECT_FALSE(traits.onlyManyShowNoise()) << "clean";
}

}  // namespace
}  // namespace segorient
