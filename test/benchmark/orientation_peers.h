// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <segorient/common/point_view.h>

#include <tuple>
#include <vector>

#ifdef SEGORIENT_HAVE_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/pca_estimate_normals.h>
#include <CGAL/property_map.h>
#endif

namespace segorient::benchmark {

/// pcl::NormalEstimationOMP, k = 18, turned to PCL's default viewpoint, the origin.
/// \return 4 floats a point
inline std::vector<float> orientWithPcl(const PointView& points) {
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < points.size; ++i) {
    cloud->push_back({points[i][0], points[i][1], points[i][2]});
  }
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setKSearch(18);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  std::vector<float> out;
  for (const pcl::Normal& n : normals) {
    out.insert(out.end(), {n.normal_x, n.normal_y, n.normal_z, n.curvature});
  }
  return out;
}

#ifdef SEGORIENT_HAVE_CGAL
/// pca_estimate_normals and mst_orient_normals, k = 18, on all cores that CGAL uses; unoriented
/// points keep the sign that they had.
inline std::vector<float> orientWithCgal(const PointView& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  // Point, normal, row: the items come back in another order.
  using Item = std::tuple<Kernel::Point_3, Kernel::Vector_3, std::size_t>;
  std::vector<Item> items;
  for (std::size_t i = 0; i < points.size; ++i) {
    items.emplace_back(Kernel::Point_3(points[i][0], points[i][1], points[i][2]),
                       Kernel::Vector_3(0, 0, 0), i);
  }
  const auto settings = CGAL::parameters::point_map(CGAL::Nth_of_tuple_property_map<0, Item>())
                            .normal_map(CGAL::Nth_of_tuple_property_map<1, Item>());
  CGAL::pca_estimate_normals<CGAL::Sequential_tag>(items, 18, settings);
  CGAL::mst_orient_normals(items, 18, settings);
  std::vector<float> out(4 * points.size, 0.F);
  for (const Item& item : items) {
    const Kernel::Vector_3& normal = std::get<1>(item);
    float* n = &out[4 * std::get<2>(item)];
    n[0] = static_cast<float>(normal.x());
    n[1] = static_cast<float>(normal.y());
    n[2] = static_cast<float>(normal.z());
  }
  return out;
}
#endif

}  // namespace segorient::benchmark
