// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "sample_files.h"

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <random>
#include <sstream>

namespace segorient::test {

pcl::PCLPointCloud2 sampleCloud(std::size_t size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-2.F, 2.F);
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (std::size_t i = 0; i < size; ++i) {
    pcl::PointXYZI p;
    p.x = coordinate(random);
    p.y = coordinate(random);
    p.z = coordinate(random);
    p.intensity = static_cast<float>(i) + 0.5F;
    cloud.push_back(p);
  }
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  return blob;
}

std::vector<SampleFile> writeSampleFiles(const ScratchDirectory& directory, std::size_t size) {
  const pcl::PCLPointCloud2 cloud = sampleCloud(size);
  pcl::PointCloud<pcl::PointXYZI> points;
  pcl::fromPCLPointCloud2(cloud, points);
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf turn = Eigen::Quaternionf::Identity();
  pcl::PCDWriter pcd;
  pcd.writeASCII(directory.file("ascii.pcd"), cloud, origin, turn, 9);
  pcd.writeBinary(directory.file("binary.pcd"), cloud);
  pcd.writeBinaryCompressed(directory.file("compressed.pcd"), cloud);
  pcl::PLYWriter ply;
  ply.writeASCII(directory.file("ascii.ply"), cloud, origin, turn, 9, false);
  ply.writeBinary(directory.file("binary.ply"), cloud, origin, turn, true);
  std::ostringstream obj;
  std::ostringstream xyz;
  obj.precision(9);
  xyz.precision(9);
  obj << "# a comment\no object\n";
  xyz << "# x y z intensity\n";
  for (const pcl::PointXYZI& p : points) {
    obj << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    xyz << p.x << ' ' << p.y << ' ' << p.z << ' ' << p.intensity << '\n';
  }
  obj << "f 1 2 3\n";
  directory.write("vertices.obj", obj.str());
  directory.write("text.xyz", xyz.str());
  return {{"ascii.pcd", true}, {"binary.pcd", false}, {"compressed.pcd", false},
          {"ascii.ply", true}, {"binary.ply", false}, {"vertices.obj", true},
          {"text.xyz", true}};
}

}  // namespace segorient::test
