// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Our normal estimation in place of PCL's: better near edges, nothing else changes.
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <segorient/features/ldt_normal_estimation.h>

#include <cmath>
#include <iostream>

int main(int argc, char** argv) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *cloud) != 0) {
    std::cerr << "usage: " << argv[0] << " CLOUD.pcd\n";
    return 2;
  }
  // was: pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  segorient::LDTNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(12);
  estimation.setViewPoint(0.F, 0.F, 100.F);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);

  std::size_t valid = 0;
  for (const pcl::Normal& n : normals) valid += std::isfinite(n.normal_x) ? 1 : 0;
  std::cout << valid << " normals of " << cloud->size() << " points\n";
  return normals.size() == cloud->size() && valid == cloud->size() ? 0 : 1;
}
