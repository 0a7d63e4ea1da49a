// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/conversions.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>

#include <algorithm>

#include "render/vtk/parts.h"

namespace segorient::program::vtk {

PoissonSurface poisson(const std::vector<std::array<float, 3>>& points,
                       const std::vector<std::array<float, 3>>& normals, int depth) {
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  for (std::size_t i = 0; i < points.size(); ++i) {
    pcl::PointNormal p;
    std::copy_n(points[i].data(), 3, p.data);
    std::copy_n(normals[i].data(), 3, p.normal);
    cloud->push_back(p);
  }
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(depth);
  poisson.setInputCloud(cloud);
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> polygons;
  poisson.performReconstruction(vertices, polygons);
  PoissonSurface out;
  for (const pcl::PointNormal& v : vertices) out.vertices.push_back({v.x, v.y, v.z});
  for (const pcl::Vertices& p : polygons) {
    if (p.vertices.size() != 3) continue;
    out.triangles.push_back({static_cast<std::uint32_t>(p.vertices[0]),
                             static_cast<std::uint32_t>(p.vertices[1]),
                             static_cast<std::uint32_t>(p.vertices[2])});
  }
  return out;
}

}  // namespace segorient::program::vtk
