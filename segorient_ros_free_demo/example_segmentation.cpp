// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Our segmentation in place of pcl::RegionGrowing: the same calls.
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <segorient/features/plane_normal_estimation.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <iostream>

int main(int argc, char** argv) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *cloud) != 0) {
    std::cerr << "usage: " << argv[0] << " CLOUD.pcd\n";
    return 2;
  }
  const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  segorient::PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(12);
  estimation.compute(*normals);

  // was: pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal> segmentation;
  segorient::NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals);
  segmentation.setMinClusterSize(20);
  std::vector<pcl::PointIndices> faces;
  segmentation.extract(faces);

  std::size_t points = 0;
  for (const pcl::PointIndices& face : faces) points += face.indices.size();
  std::cout << faces.size() << " faces with " << points << " of " << cloud->size() << " points\n";
  return !faces.empty() && points * 10 > cloud->size() * 9 ? 0 : 1;
}
