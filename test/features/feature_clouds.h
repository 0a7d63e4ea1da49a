// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/common/impl/cloud_access.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

namespace segorient::test {

constexpr double kDegree = M_PI / 180.0;

/// Points with their true normals.
struct Sample {
  pcl::PointCloud<pcl::PointXYZ> points;
  std::vector<Eigen::Vector3f> normals;

  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
    points.push_back({p.x(), p.y(), p.z()});
    normals.push_back(n);
  }
  PointView view() const { return {&points[0].x, 4, points.size()}; }
};

/// Angle between directions without sign, accurate for small ones.
inline double angleBetween(const Eigen::Vector3f& a, const float* b) {
  const Eigen::Vector3d u = a.cast<double>();
  const Eigen::Vector3d v(b[0], b[1], b[2]);
  return std::atan2(u.cross(v).norm(), std::abs(u.dot(v)));
}

inline double rmsDegrees(const Sample& sample, const std::vector<float>& normals) {
  double sum = 0;
  for (std::size_t i = 0; i < sample.normals.size(); ++i) {
    const double angle = angleBetween(sample.normals[i], &normals[4 * i]);
    sum += angle * angle;
  }
  return std::sqrt(sum / static_cast<double>(sample.normals.size())) / kDegree;
}

/// Torus with radii 1 and 0.4, uniform by area.
/// \param noise standard deviation of an offset along the normal
inline Sample torus(std::size_t count, unsigned seed, float noise = 0.F) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.F, 1.F);
  std::normal_distribution<float> gauss(0.F, 1.F);
  Sample sample;
  while (sample.normals.size() < count) {
    const float u = 2.F * static_cast<float>(M_PI) * uniform(generator);
    const float v = 2.F * static_cast<float>(M_PI) * uniform(generator);
    if (uniform(generator) * 1.4F > 1.F + 0.4F * std::cos(v)) continue;
    const Eigen::Vector3f ring(std::cos(u), std::sin(u), 0.F);
    const Eigen::Vector3f n = std::cos(v) * ring + std::sin(v) * Eigen::Vector3f::UnitZ();
    sample.add(ring + (0.4F + noise * gauss(generator)) * n, n);
  }
  return sample;
}

/// Mean distance between points of a cloud of this many points over a torus as above.
inline float torusSpacing(std::size_t count) {
  return std::sqrt(4.F * static_cast<float>(M_PI * M_PI) * 0.4F / static_cast<float>(count));
}

inline Sample sphere(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> gauss(0.F, 1.F);
  Sample sample;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f n =
        Eigen::Vector3f(gauss(generator), gauss(generator), gauss(generator)).normalized();
    sample.add(n, n);
  }
  return sample;
}

/// A plane of given unit normal through `origin`, 2 wide.
inline Sample plane(std::size_t count, unsigned seed, const Eigen::Vector3f& normal,
                    const Eigen::Vector3f& origin = Eigen::Vector3f::Zero()) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(-1.F, 1.F);
  const Eigen::Vector3f u = normal.unitOrthogonal();
  const Eigen::Vector3f v = normal.cross(u);
  Sample sample;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = origin + uniform(generator) * u + uniform(generator) * v;
    sample.add(p, normal);
  }
  return sample;
}

/// The surface of the cube [-1, 1]^3.
inline Sample cube(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(-1.F, 1.F);
  Sample sample;
  for (std::size_t i = 0; i < count; ++i) {
    const auto axis = static_cast<Eigen::Index>(i % 3);
    Eigen::Vector3f p(uniform(generator), uniform(generator), uniform(generator));
    Eigen::Vector3f n = Eigen::Vector3f::Zero();
    n[axis] = p[axis] = i % 6 < 3 ? 1.F : -1.F;
    sample.add(p, n);
  }
  return sample;
}

/// Neighbours of all points, k beside the point itself.
inline Neighborhoods neighborsOf(const PointView& points, int k) {
  search::MedianHashIndex index;
  index.build(points, nullptr, {});
  Neighborhoods table;
  index.nearestKAll(k + 1, table);
  return table;
}

}  // namespace segorient::test
