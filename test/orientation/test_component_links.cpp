// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Parts that no neighbour connects with the rest of a surface, and that are too narrow for a
// winding number of their own.
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace segorient {
namespace {

// Vertices by latitude, as modelling programs make them, about a tilted axis.
struct Globe {
  std::vector<float> xyz;
  std::vector<Eigen::Vector3d> out;

  void addRow(double latitude, int count) {
    static const Eigen::Matrix3d kTilt =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * M_PI * (i + 0.31 * latitude) / count;
      out.push_back(kTilt * Eigen::Vector3d(std::cos(latitude) * std::cos(angle),
                                            std::cos(latitude) * std::sin(angle),
                                            std::sin(latitude)));
      for (const double v : out.back()) xyz.push_back(static_cast<float>(v));
    }
  }
};

OrientedCloud oriented(const Globe& globe,
                       const std::shared_ptr<OrientationHints>& hints = nullptr) {
  PipelineOptions options;
  options.orientation.hints = hints;
  options.orientation.automatic.find_sensors = false;
  return orientCloud({globe.xyz.data(), 3, globe.out.size()}, nullptr, options);
}

double shareOutward(const Globe& globe, const OrientedCloud& cloud) {
  std::size_t right = 0;
  for (std::size_t i = 0; i < globe.out.size(); ++i) {
    const float* n = &cloud.normals[4 * i];
    const Eigen::Vector3d normal(static_cast<double>(n[0]), static_cast<double>(n[1]),
                                 static_cast<double>(n[2]));
    right += normal.dot(globe.out[i]) > 0.0 ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(globe.out.size());
}

TEST(ComponentLinks, CirclesAroundThePolesFaceOutward) {
  for (const int around : {100, 300}) {
    Globe globe;
    const int rows = around / 4;
    for (int r = 0; r < rows; ++r) globe.addRow(M_PI * ((r + 0.5) / rows - 0.5), around);
    const OrientedCloud cloud = oriented(globe);
    EXPECT_GT(cloud.report.components.size(), 2U) << "the circles are connected";
    EXPECT_EQ(shareOutward(globe, cloud), 1.0) << around;
  }
}

// Who turns the rest turns them with it.
TEST(ComponentLinks, CirclesFollowASeed) {
  Globe globe;
  for (int r = 0; r < 75; ++r) globe.addRow(M_PI * ((r + 0.5) / 75 - 0.5), 300);
  const std::size_t middle = globe.out.size() / 2;
  const auto hints = std::make_shared<OrientationHints>();
  OrientationHints::Seed& inward = hints->seeds.emplace_back();
  for (Eigen::Index a = 0; a < 3; ++a) {
    inward.position[static_cast<std::size_t>(a)] = static_cast<float>(globe.out[middle][a]);
    inward.normal[static_cast<std::size_t>(a)] = static_cast<float>(-globe.out[middle][a]);
  }
  EXPECT_EQ(shareOutward(globe, oriented(globe, hints)), 0.0);
}

// Each half has one layer over any plane, as ground has, but the other one closes it.
TEST(ComponentLinks, HalvesOfAClosedSurfaceAreNoGround) {
  Globe globe;
  constexpr double kStep = M_PI / 90.0;
  for (int r = 1; r < 45; ++r) {
    const double latitude = 0.08 + r * kStep;
    if (latitude > M_PI / 2.0 - kStep) break;
    const int count = static_cast<int>(2.0 * M_PI * std::cos(latitude) / kStep);
    globe.addRow(latitude, count);
    globe.addRow(-latitude, count);
  }
  const OrientedCloud cloud = oriented(globe);
  EXPECT_GE(cloud.report.components.size(), 2U) << "the halves are connected";
  EXPECT_EQ(shareOutward(globe, cloud), 1.0);
}

}  // namespace
}  // namespace segorient
