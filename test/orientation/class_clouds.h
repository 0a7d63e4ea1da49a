// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>

#include "oriented_shapes.h"

namespace segorient::test {

template <typename PointT = pcl::PointXYZ>
typename pcl::PointCloud<PointT>::Ptr toPcl(const LabelledCloud& cloud) {
  auto out = pcl::make_shared<pcl::PointCloud<PointT>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    PointT point;
    point.x = cloud.xyz[4 * i];
    point.y = cloud.xyz[4 * i + 1];
    point.z = cloud.xyz[4 * i + 2];
    out->push_back(point);
  }
  return out;
}

inline pcl::PointCloud<pcl::Normal>::Ptr toPclNormals(const std::vector<float>& normals) {
  auto out = pcl::make_shared<pcl::PointCloud<pcl::Normal>>();
  for (std::size_t i = 0; i < normals.size() / 4; ++i) {
    out->push_back(pcl::Normal(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]));
  }
  return out;
}

template <typename NormalT>
bool agrees(const NormalT& normal, const LabelledCloud& cloud, std::size_t i) {
  const float* t = &cloud.normals[4 * i];
  return normal.normal_x * t[0] + normal.normal_y * t[1] + normal.normal_z * t[2] > 0.F;
}

}  // namespace segorient::test
