// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// A surface from a cloud without normals: oriented normals, then pcl::Poisson.
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>
#include <segorient/orientation/oriented_normal_estimation.h>

#include <iostream>

int main(int argc, char** argv) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc < 2 || argc > 3 || pcl::io::loadPCDFile(argv[1], *cloud) != 0) {
    std::cerr << "usage: " << argv[0] << " CLOUD.pcd [SURFACE.ply]\n";
    return 2;
  }
  // A PointNormal output carries x, y, z as well.
  const pcl::PointCloud<pcl::PointNormal>::Ptr oriented(new pcl::PointCloud<pcl::PointNormal>);
  segorient::OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.compute(*oriented);

  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(6);
  poisson.setInputCloud(oriented);
  pcl::PolygonMesh surface;
  poisson.reconstruct(surface);
  std::cout << surface.polygons.size() << " triangles\n";
  if (argc == 3 && pcl::io::savePLYFileBinary(argv[2], surface) != 0) return 1;
  return surface.polygons.size() > 1000 ? 0 : 1;
}
