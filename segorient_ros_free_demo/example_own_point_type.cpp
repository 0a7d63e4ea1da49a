// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// A point type of one's own: with PCL_NO_PRECOMPILE, before any header, templates are compiled
// here.
#define PCL_NO_PRECOMPILE
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <segorient/orientation/oriented_normal_estimation.h>

#include <cmath>
#include <iostream>

struct ScanPoint {
  PCL_ADD_POINT4D;
  float time;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(ScanPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, time, time))

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ> file;
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], file) != 0) {
    std::cerr << "usage: " << argv[0] << " CLOUD.pcd\n";
    return 2;
  }
  const pcl::PointCloud<ScanPoint>::Ptr cloud(new pcl::PointCloud<ScanPoint>);
  for (const pcl::PointXYZ& p : file) {
    ScanPoint own;
    own.getVector4fMap() = p.getVector4fMap();
    own.time = 0.F;
    cloud->push_back(own);
  }
  segorient::OrientedNormalEstimation<ScanPoint, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::PointNormal> oriented;
  estimation.compute(oriented);

  std::size_t valid = 0;
  for (const pcl::PointNormal& p : oriented) valid += std::isfinite(p.normal_x) ? 1 : 0;
  std::cout << valid << " oriented normals, " << estimation.getSegments().size() << " segments\n";
  return valid == cloud->size() ? 0 : 1;
}
