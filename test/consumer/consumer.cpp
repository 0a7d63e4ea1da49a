// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Points of a sphere: all normals must point outward, and the nearest neighbour of each point is
// itself.
#include <pcl/point_types.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/search/median_hash.h>

#include <cmath>
#include <iostream>

int main() {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  const int size = 4000;
  for (int i = 0; i < size; ++i) {
    const float z = 1.F - 2.F * (static_cast<float>(i) + 0.5F) / static_cast<float>(size);
    const float r = std::sqrt(1.F - z * z);
    const float angle = 2.3999632F * static_cast<float>(i);
    cloud->push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  segorient::search::MedianHash<pcl::PointXYZ> search;
  search.setInputCloud(cloud);
  pcl::Indices indices;
  std::vector<float> distances;
  if (search.nearestKSearch(5, 3, indices, distances) != 3 || indices[0] != 5) return 1;

  segorient::OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  int outward = 0;
  for (int i = 0; i < size && normals.size() == cloud->size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    const float dot = normals[row].getNormalVector3fMap().dot((*cloud)[row].getVector3fMap());
    if (dot > 0.9F) ++outward;
  }
  std::cout << outward << " of " << size << " normals point outward\n";
  return outward == size ? 0 : 1;
}
