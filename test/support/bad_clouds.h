// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace segorient::test {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Whether the finite points of a cloud have a plane around them.
enum class Planes { NONE, MAYBE, NEARLY_ALL };

/// A cloud that point cloud code is known to fail on.
struct BadCloud {
  std::string name;
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud;
  Planes planes = Planes::NEARLY_ALL;
};

/// Indices into a cloud of some size, good and bad ones.
struct IndexCase {
  std::string name;
  pcl::IndicesPtr indices;  ///< null = all points
};

/// For tests that make PCL_ERROR speak all the time.
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

/// A gently curved patch, the unharmed original of the bad clouds.
inline pcl::PointCloud<pcl::PointXYZ> curvedPatch(std::size_t size) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(-1.F, 1.F);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (std::size_t i = 0; i < size; ++i) {
    const float x = unit(random);
    const float y = unit(random);
    cloud.emplace_back(x, y, 0.2F * x * x - 0.1F * x * y);
  }
  return cloud;
}

inline std::vector<BadCloud> badClouds() {
  using Point = pcl::PointXYZ;
  constexpr std::size_t kSize = 150;
  std::vector<BadCloud> out;
  const auto keep = [&](const std::string& name, Planes planes, std::size_t size) {
    auto cloud = pcl::make_shared<pcl::PointCloud<Point>>(curvedPatch(kSize));
    cloud->resize(size);
    out.push_back({name, cloud, planes});
    return cloud;
  };
  const auto each = [&](const std::string& name, Planes planes,
                        const std::function<void(std::size_t, Point&)>& change) {
    const auto cloud = keep(name, planes, kSize);
    for (std::size_t i = 0; i < kSize; ++i) change(i, (*cloud)[i]);
    return cloud;
  };
  const auto scaled = [&](const std::string& name, float factor) {
    each(name, Planes::NEARLY_ALL, [=](std::size_t, Point& p) { p.getVector3fMap() *= factor; });
  };

  keep("unharmed", Planes::NEARLY_ALL, kSize);
  keep("empty", Planes::NONE, 0);
  keep("one point", Planes::NONE, 1);
  keep("two points", Planes::NONE, 2);
  keep("three points", Planes::NEARLY_ALL, 3);
  each("all duplicates", Planes::NONE, [](std::size_t, Point& p) { p = Point(1.F, 2.F, 3.F); });
  each("half duplicates", Planes::NEARLY_ALL, [](std::size_t i, Point& p) {
    if (i % 2 == 0) p = Point(0.1F, 0.2F, 0.F);
  });
  each("every point twice", Planes::NEARLY_ALL,
       [](std::size_t i, Point& p) { p = (&p)[-static_cast<int>(i % 2)]; });
  each("collinear", Planes::NONE, [](std::size_t, Point& p) { p = Point(p.x, 2.F * p.x, -p.x); });
  each("coplanar", Planes::NEARLY_ALL, [](std::size_t, Point& p) { p.z = 0.5F; });
  for (const bool dense : {true, false}) {
    const std::string said = dense ? ", said to be dense" : "";
    each("some NaN" + said, Planes::NEARLY_ALL, [](std::size_t i, Point& p) {
      if (i % 10 == 3) p.y = kNaN;
    })->is_dense = dense;
    each("some infinite" + said, Planes::NEARLY_ALL, [](std::size_t i, Point& p) {
      if (i % 10 == 3) (i % 20 == 3 ? p.x : p.z) = i % 20 == 3 ? kInfinity : -kInfinity;
    })->is_dense = dense;
    each("all NaN" + said, Planes::NONE, [](std::size_t, Point& p) { p.x = kNaN; })->is_dense =
        dense;
  }
  scaled("1e30", 1e30F);
  scaled("1e-30", 1e-30F);
  scaled("denormal", 1e-41F);
  each("largest floats", Planes::MAYBE, [](std::size_t i, Point& p) {
    const float most = std::numeric_limits<float>::max();
    p = Point(i % 2 == 0 ? most : -most, i % 3 == 0 ? most : -most, i % 5 == 0 ? most : -most);
  });
  each("map coordinates", Planes::NEARLY_ALL, [](std::size_t, Point& p) {
    p = Point(4.5e5F + 100.F * p.x, 5.4e6F + 100.F * p.y, 300.F + 100.F * p.z);
  });
  each("one far away", Planes::MAYBE, [](std::size_t i, Point& p) {
    if (i == 0) p = Point(1e20F, 0.F, 0.F);
  });
  const auto organized =
      each("organised with holes", Planes::NEARLY_ALL, [](std::size_t i, Point& p) {
        p = i % 7 == 0 ? Point(kNaN, kNaN, kNaN)
                       : Point(static_cast<float>(i % 15), static_cast<float>(i / 15), 0.F);
      });
  organized->width = 15;
  organized->height = 10;
  organized->is_dense = false;
  return out;
}

inline std::vector<IndexCase> indexCases(std::size_t size) {
  const auto n = static_cast<pcl::index_t>(size);
  using Limits = std::numeric_limits<pcl::index_t>;
  const auto make = [](pcl::Indices indices) {
    return pcl::make_shared<pcl::Indices>(std::move(indices));
  };
  std::vector<IndexCase> out{{"all", nullptr},
                             {"none", make({})},
                             {"out of range", make({n, n + 7, Limits::max()})},
                             {"negative", make({-1, Limits::min()})},
                             {"good and bad", make({0, -1, 1, n, 2})},
                             {"repeated", make({2, 2, 0, 2, 0})}};
  pcl::Indices backwards;
  for (pcl::index_t i = n - 1; i >= 0; --i) backwards.push_back(i);
  out.push_back({"backwards", make(backwards)});
  return out;
}

/// Calls check(cloud, indices) for every bad cloud with all indices for its size; failures say
/// which they belong to.
template <typename Check>
void forEachBadInput(const Check& check) {
  for (const BadCloud& bad : badClouds()) {
    SCOPED_TRACE(bad.name);
    for (const IndexCase& index : indexCases(bad.cloud->size())) {
      SCOPED_TRACE(index.name);
      check(bad, index);
    }
  }
}

/// The point that an output's row belongs to; null where there is none.
inline const pcl::PointXYZ* pointOf(const pcl::PointCloud<pcl::PointXYZ>& cloud,
                                    const pcl::IndicesPtr& indices, std::size_t row) {
  const auto at = indices ? static_cast<std::size_t>((*indices)[row]) : row;
  const bool valid = at < cloud.size() && std::isfinite(cloud[at].x) &&
                     std::isfinite(cloud[at].y) && std::isfinite(cloud[at].z);
  return valid ? &cloud[at] : nullptr;
}

/// Whether a normal is a unit vector, or NaN in all of its parts.
template <typename NormalT>
bool isUnitOrNan(const NormalT& n) {
  if (std::isnan(n.normal_x)) return std::isnan(n.normal_y) && std::isnan(n.normal_z);
  return std::abs(n.getNormalVector3fMap().norm() - 1.F) < 1e-4F;
}

/// Expects a row for each point: of NaN where there is no valid point, and of unit normals as far
/// as the cloud and the settings allow.
/// \param most what the settings allow
inline void checkNormals(const BadCloud& bad, const IndexCase& index,
                         const pcl::PointCloud<pcl::Normal>& out,
                         Planes most = Planes::NEARLY_ALL) {
  const std::size_t all = index.indices ? index.indices->size() : bad.cloud->size();
  const std::size_t rows = bad.cloud->empty() ? 0 : all;
  ASSERT_EQ(out.size(), rows);
  std::size_t valid = 0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    ASSERT_TRUE(isUnitOrNan(out[i])) << i << ": " << out[i];
    const bool is_point = pointOf(*bad.cloud, index.indices, i) != nullptr;
    const bool has_normal = !std::isnan(out[i].normal_x);
    ASSERT_TRUE(is_point || !has_normal) << i;
    valid += is_point ? 1 : 0;
    found += has_normal ? 1 : 0;
  }
  EXPECT_EQ(out.is_dense, found == rows);
  if (bad.planes == Planes::NONE || most == Planes::NONE) {
    EXPECT_EQ(found, 0U);
  }
  if (bad.planes == Planes::NEARLY_ALL && most == Planes::NEARLY_ALL) {
    EXPECT_GE(10 * found, 9 * valid) << found << " of " << valid;
  }
}

}  // namespace segorient::test
