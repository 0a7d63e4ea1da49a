// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/point_types.h>
#include <pcl/visualization/pcl_visualizer.h>

#include <algorithm>
#include <cmath>

#include "render/vtk/parts.h"

namespace segorient::program::vtk {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZRGBNormal>;

// The scene's points with the colours of their fronts; NaN normals where there are none.
Cloud::Ptr cloudOf(const Scene& scene) {
  Cloud::Ptr cloud(new Cloud);
  const auto add = [&](const std::array<float, 3>& position, const std::array<float, 3>& normal,
                       std::uint32_t rgb) {
    pcl::PointXYZRGBNormal p;
    std::copy_n(position.data(), 3, p.data);
    std::copy_n(normal.data(), 3, p.normal);
    p.r = static_cast<std::uint8_t>(rgb >> 16);
    p.g = static_cast<std::uint8_t>(rgb >> 8);
    p.b = static_cast<std::uint8_t>(rgb);
    cloud->push_back(p);
  };
  for (const Splat& s : scene.splats) add(s.position, s.normal, s.front);
  for (const auto& v : scene.vertices) add(v, {NAN, NAN, NAN}, 0xffffffU);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    for (const std::uint32_t v : scene.triangles[i]) {
      (*cloud)[v].r = static_cast<std::uint8_t>(scene.front[i] >> 16);
      (*cloud)[v].g = static_cast<std::uint8_t>(scene.front[i] >> 8);
      (*cloud)[v].b = static_cast<std::uint8_t>(scene.front[i]);
    }
  }
  return cloud;
}

}  // namespace

void show(const Scene& scene, int every, double length) {
  pcl::visualization::PCLVisualizer viewer("segorient");
  const Cloud::Ptr cloud = cloudOf(scene);
  const pcl::visualization::PointCloudColorHandlerRGBField<pcl::PointXYZRGBNormal> colors(cloud);
  if (scene.triangles.empty()) {
    viewer.addPointCloud<pcl::PointXYZRGBNormal>(cloud, colors, "cloud");
    viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, 3,
                                            "cloud");
  } else {
    std::vector<pcl::Vertices> polygons(scene.triangles.size());
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      polygons[i].vertices.assign(scene.triangles[i].begin(), scene.triangles[i].end());
    }
    viewer.addPolygonMesh<pcl::PointXYZRGBNormal>(cloud, polygons, "mesh");
  }
  const bool normals = !scene.splats.empty() && every > 0;
  if (normals) {
    viewer.addPointCloudNormals<pcl::PointXYZRGBNormal>(cloud, every, static_cast<float>(length),
                                                        "normals");
  }
  viewer.resetCamera();
  viewer.spin();
}

}  // namespace segorient::program::vtk
