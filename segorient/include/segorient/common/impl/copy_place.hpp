// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <limits>

namespace segorient {

/// Gives a result the place of the point that it is of, where its type has one: NaN if there is no
/// such point.
template <typename PointT, typename ResultT>
void copyPlace(const pcl::PointCloud<PointT>& cloud, pcl::index_t index, ResultT& result) {
  if constexpr (pcl::traits::has_xyz<ResultT>::value) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const auto i = static_cast<std::size_t>(index);
    const bool in_range = index >= 0 && i < cloud.size();
    result.x = in_range ? static_cast<float>(cloud[i].x) : kNaN;
    result.y = in_range ? static_cast<float>(cloud[i].y) : kNaN;
    result.z = in_range ? static_cast<float>(cloud[i].z) : kNaN;
  }
}

}  // namespace segorient
