// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The hash search in place of pcl::search::KdTree in a PCL class: one type changes.
#include <pcl/features/normal_3d_omp.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <segorient/search/median_hash.h>

#include <iostream>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

pcl::PointCloud<pcl::Normal> normals(const Cloud::Ptr& cloud,
                                     const pcl::search::Search<pcl::PointXYZ>::Ptr& search) {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(search);
  estimation.setKSearch(12);
  pcl::PointCloud<pcl::Normal> out;
  estimation.compute(out);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const Cloud::Ptr cloud(new Cloud);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *cloud) != 0) {
    std::cerr << "usage: " << argv[0] << " CLOUD.pcd\n";
    return 2;
  }
  const auto by_tree = normals(cloud, pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  const auto by_hash =
      normals(cloud, pcl::make_shared<segorient::search::MedianHash<pcl::PointXYZ>>());

  std::size_t different = 0;
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    const float cosine = by_tree[i].getNormalVector3fMap().dot(by_hash[i].getNormalVector3fMap());
    if (!(cosine > 0.999F)) ++different;
  }
  std::cout << cloud->size() << " normals, " << different << " differ\n";
  return different * 1000 < cloud->size() ? 0 : 1;
}
