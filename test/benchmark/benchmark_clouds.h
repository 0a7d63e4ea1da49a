// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace segorient::benchmark {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// n points uniformly in a cube.
inline Cloud::Ptr uniformCube(std::size_t n, unsigned int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(0.0F, 1.0F);
  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < n; ++i) cloud->push_back({u(random), u(random), u(random)});
  return cloud;
}

/// n points at random on a bumpy sphere, with a little noise.
inline Cloud::Ptr bumpySphere(std::size_t n, unsigned int seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> g(0.0F, 1.0F);
  const float spacing = std::sqrt(12.6F / static_cast<float>(n));
  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < n; ++i) {
    Eigen::Vector3f p(g(random), g(random), g(random));
    p.normalize();
    const float bump = 1.0F + 0.15F * std::sin(7.0F * p.x()) * std::cos(5.0F * p.y() + p.z());
    p *= bump + 0.05F * spacing * g(random);
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  return cloud;
}

/// n points as a turning scanner of 64 lines sees a street: density falls with distance, dense
/// along lines, sparse across them. In scan order.
inline Cloud::Ptr lidarLike(std::size_t n, unsigned int seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> g(0.0F, 1.0F);
  const std::size_t lines = 64;
  const std::size_t per_line = n / lines + 1;
  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t line = 0; line < lines; ++line) {
    const float elevation = -0.42F + 0.0075F * static_cast<float>(line);
    for (std::size_t i = 0; i < per_line && cloud->size() < n; ++i) {
      const float turn = 6.2832F * static_cast<float>(i) / static_cast<float>(per_line);
      // Walls to both sides and some poles, on a plane 1.8 below the sensor.
      const float wall = 9.0F / std::max(std::abs(std::sin(turn)), 0.09F);
      const float pole = std::sin(31.0F * turn) > 0.97F ? 6.0F : 1e3F;
      const float ground = elevation < -0.01F ? 1.8F / std::tan(-elevation) : 1e3F;
      const float range = std::min({wall, pole, ground, 100.0F}) + 0.01F * g(random);
      cloud->push_back({range * std::cos(turn), range * std::sin(turn),
                        std::max(range * std::tan(elevation), -1.8F) + 0.01F * g(random)});
    }
  }
  return cloud;
}

inline std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

/// The same points along a space-filling curve: neighbours in space are neighbours in memory.
inline Cloud::Ptr alongCurve(const Cloud& cloud) {
  Eigen::Vector3f lo = cloud.front().getVector3fMap();
  Eigen::Vector3f hi = lo;
  for (const auto& p : cloud) {
    lo = lo.cwiseMin(p.getVector3fMap());
    hi = hi.cwiseMax(p.getVector3fMap());
  }
  const float scale = 2097151.0F / std::max((hi - lo).maxCoeff(), 1e-30F);
  std::vector<std::pair<std::uint64_t, std::size_t>> order(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f c = (cloud[i].getVector3fMap() - lo) * scale;
    order[i] = {spread(static_cast<std::uint64_t>(c.x())) |
                    spread(static_cast<std::uint64_t>(c.y())) << 1 |
                    spread(static_cast<std::uint64_t>(c.z())) << 2,
                i};
  }
  std::sort(order.begin(), order.end());
  auto sorted = pcl::make_shared<Cloud>();
  for (const auto& entry : order) sorted->push_back(cloud[entry.second]);
  return sorted;
}

inline Cloud::Ptr shuffled(const Cloud& cloud, unsigned int seed) {
  auto copy = pcl::make_shared<Cloud>(cloud);
  std::mt19937 random(seed);
  std::shuffle(copy->points.begin(), copy->points.end(), random);
  return copy;
}

}  // namespace segorient::benchmark
