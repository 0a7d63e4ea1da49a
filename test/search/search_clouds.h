// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/point_view.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace segorient::test {

/// A named cloud, 4 floats a point.
struct SearchCloud {
  std::string name;
  std::vector<float> xyz;

  std::size_t size() const { return xyz.size() / 4; }
  PointView view() const { return {xyz.data(), 4, size()}; }
  void add(double x, double y, double z) {
    for (const double v : {x, y, z, 0.0}) xyz.push_back(static_cast<float>(v));
  }
  /// Whether this is the index of a point with finite coordinates.
  bool has(pcl::index_t index) const {
    const auto row = static_cast<std::size_t>(index);
    return index >= 0 && row < size() && isFinite(view()[row]);
  }
};

inline std::ostream& operator<<(std::ostream& out, const SearchCloud& cloud) {
  return out << cloud.name;
}

/// Every other point, from the last to the first, one of them twice, and two that are no points.
inline std::vector<pcl::index_t> everyOtherIndex(const SearchCloud& cloud) {
  std::vector<pcl::index_t> indices;
  for (std::size_t i = 0; i < cloud.size(); i += 2) {
    indices.push_back(static_cast<pcl::index_t>(cloud.size() - 1 - i));
  }
  indices.push_back(indices.front());
  indices.insert(indices.begin() + 5, -7);
  indices.push_back(static_cast<pcl::index_t>(cloud.size()));
  return indices;
}

/// Clouds on which a search goes wrong in different ways, about n points each.
inline std::vector<SearchCloud> searchClouds(std::size_t n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  std::normal_distribution<double> g(0.0, 1.0);
  std::vector<SearchCloud> clouds;
  // Calls make(cloud) n times.
  const auto fill = [&](const std::string& name, auto&& make) {
    SearchCloud cloud{name, {}};
    while (cloud.size() < n) make(cloud);
    clouds.push_back(cloud);
  };
  fill("uniform", [&](auto& c) { c.add(u(random), u(random), u(random)); });
  fill("surface", [&](auto& c) {
    const double x = u(random);
    const double y = u(random);
    c.add(x, y, 0.3 * std::sin(4 * x) * std::cos(3 * y));
  });
  fill("clustered", [&](auto& c) {
    const double center = std::floor(5 * u(random));
    const double width = std::pow(10.0, -std::abs(center));
    c.add(center + width * g(random), width * g(random), width * g(random));
  });
  fill("planar", [&](auto& c) { c.add(u(random), 0.25, u(random)); });
  fill("collinear", [&](auto& c) {
    const double t = u(random);
    c.add(t, 2 * t, -t);
  });
  fill("grid, many ties", [&](auto& c) {
    c.add(std::round(8 * u(random)), std::round(8 * u(random)), std::round(8 * u(random)));
  });
  fill("one place", [&](auto& c) { c.add(0.5, -3.0, 0.125); });
  fill("pairs", [&](auto& c) {
    const double x = u(random);
    const double y = u(random);
    c.add(x, y, x * y);
    c.add(x, y, x * y);
  });
  fill("aspect ratio", [&](auto& c) { c.add(1e4 * u(random), u(random), 1e-4 * u(random)); });
  fill("cluster in a huge box", [&](auto& c) {
    const double scale = c.size() < 8 ? 1e6 : 1.0;
    c.add(scale * u(random), scale * u(random), scale * u(random));
  });
  fill("lidar-like", [&](auto& c) {
    const double range = 1.0 / (0.01 + 0.5 * (u(random) + 1.0));
    const double angle = 3.0 * u(random);
    c.add(range * std::cos(angle), range * std::sin(angle), 0.05 * std::sin(range));
  });
  fill("far from the origin", [&](auto& c) {
    c.add(4.5e6 + 50 * u(random), 5.4e5 + 50 * u(random), 300 + 5 * u(random));
  });
  fill("denormal squares",
       [&](auto& c) { c.add(1e-21 * u(random), 1e-21 * u(random), 1e-21 * u(random)); });
  fill("tiny", [&](auto& c) { c.add(1e-30 * u(random), 1e-30 * u(random), 1e-30 * u(random)); });
  fill("huge", [&](auto& c) { c.add(1e18 * u(random), 1e18 * u(random), 1e18 * u(random)); });
  fill("overflowing squares",
       [&](auto& c) { c.add(1e30 * u(random), 1e30 * u(random), 1e30 * u(random)); });
  fill("largest floats", [&](auto& c) {
    const double most = std::numeric_limits<float>::max();
    c.add(u(random) < 0 ? most : -most, u(random) < 0 ? most : -most, u(random));
  });
  fill("with holes", [&](auto& c) {
    const double bad = u(random) < 0 ? std::numeric_limits<double>::quiet_NaN()
                                     : std::numeric_limits<double>::infinity();
    c.add(u(random), u(random) < -0.8 ? bad : u(random), u(random));
  });
  return clouds;
}

}  // namespace segorient::test
