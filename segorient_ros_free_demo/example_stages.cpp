// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The stages by hand, on points that carry an intensity; neighbours are found once.
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <segorient/features/awas_normal_estimation.h>
#include <segorient/orientation/segment_orientation.h>
#include <segorient/search/median_hash.h>
#include <segorient/segmentation/normal_segmentation.h>

#include <iostream>
#include <memory>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ> file;
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], file) != 0) {
    std::cerr << "usage: " << argv[0] << " CLOUD.pcd\n";
    return 2;
  }
  const pcl::PointCloud<pcl::PointXYZI>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZI>);
  pcl::copyPointCloud(file, *cloud);

  segorient::search::MedianHash<pcl::PointXYZI> search;
  search.setInputCloud(cloud);
  const auto neighbors = pcl::make_shared<segorient::Neighborhoods>();
  search.nearestKSearchAll(13, *neighbors);

  const pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  segorient::AwASNormalEstimation<pcl::PointXYZI, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setNeighborhoods(neighbors);
  estimation.compute(*normals);

  segorient::NormalSegmentation<pcl::PointXYZI, pcl::Normal> segmentation;
  segmentation.setInputCloud(cloud);
  segmentation.setInputNormals(normals);
  segmentation.setNeighborhoods(neighbors);
  std::vector<pcl::PointIndices> segments;
  segmentation.extract(segments);

  segorient::SegmentOrientation<pcl::PointXYZI, pcl::Normal> orientation;
  orientation.setInputCloud(cloud);
  orientation.setInputNormals(normals);
  orientation.setNeighborhoods(neighbors);
  orientation.setSegmentation(
      std::make_shared<const segorient::Segmentation>(segmentation.getPlanarSegmentation()));
  pcl::PointCloud<pcl::Normal> oriented;
  orientation.compute(oriented);

  std::cout << segments.size() << " segments, " << oriented.size() << " oriented normals\n";
  return oriented.size() == cloud->size() && !segments.empty() ? 0 : 1;
}
