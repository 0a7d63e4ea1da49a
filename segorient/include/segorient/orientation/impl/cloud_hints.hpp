// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/type_traits.h>
#include <segorient/orientation/orientation_hints.h>

namespace segorient::detail {

/// Where each point was seen from, if the point type says so (vp_x, vp_y, vp_z).
template <typename PointT>
void addViewpoints(const pcl::PointCloud<PointT>& cloud, OrientationHints& hints) {
  if constexpr (pcl::traits::has_field<PointT, pcl::fields::vp_x>::value &&
                pcl::traits::has_field<PointT, pcl::fields::vp_y>::value &&
                pcl::traits::has_field<PointT, pcl::fields::vp_z>::value) {
    hints.viewpoints.reserve(3 * cloud.size());
    for (const PointT& p : cloud) {
      for (const float v : {p.vp_x, p.vp_y, p.vp_z}) hints.viewpoints.push_back(v);
    }
  }
}

/// The range image that an organized cloud is.
template <typename PointT>
void addGrid(const pcl::PointCloud<PointT>& cloud, OrientationHints& hints) {
  if (cloud.isOrganized()) hints.grids.push_back({0, cloud.width, cloud.height});
}

/// The normals that the points have, if their type has any.
template <typename PointT>
void addNormals(const pcl::PointCloud<PointT>& cloud, OrientationHints& hints) {
  if constexpr (pcl::traits::has_normal<PointT>::value) {
    hints.normals.reserve(3 * cloud.size());
    for (const PointT& p : cloud) {
      for (const float n : {p.normal_x, p.normal_y, p.normal_z}) hints.normals.push_back(n);
    }
  }
}

inline void addSeeds(const pcl::PointCloud<pcl::PointNormal>& seeds, OrientationHints& hints) {
  for (const pcl::PointNormal& s : seeds) {
    hints.seeds.push_back({{s.x, s.y, s.z}, {s.normal_x, s.normal_y, s.normal_z}});
  }
}

}  // namespace segorient::detail
