// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <segorient/common/point_view.h>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace segorient {

/// Points of a PCL cloud as a PointView: in place where x, y, z are consecutive floats in the point
/// type, otherwise as a copy that this object owns.
template <typename PointT>
class CloudPoints {
 public:
  CloudPoints() = default;
  /// \param cloud must outlive this object
  explicit CloudPoints(const pcl::PointCloud<PointT>& cloud) { assign(cloud); }

  void assign(const pcl::PointCloud<PointT>& cloud) {
    view_ = PointView{};
    view_.size = cloud.size();
    if (cloud.empty()) return;
    if (inPlace(cloud.points.front())) {
      view_.data = firstFloat(cloud.points.front());
      view_.stride = sizeof(PointT) / sizeof(float);
      return;
    }
    copy_.resize(4 * cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      copy_[4 * i] = static_cast<float>(cloud[i].x);
      copy_[4 * i + 1] = static_cast<float>(cloud[i].y);
      copy_[4 * i + 2] = static_cast<float>(cloud[i].z);
      copy_[4 * i + 3] = 0.0F;
    }
    view_.data = copy_.data();
    view_.stride = 4;
  }

  const PointView& view() const { return view_; }

 private:
  static bool inPlace(const PointT& p) {
    if (!std::is_same_v<std::decay_t<decltype(p.x)>, float> ||
        sizeof(PointT) % sizeof(float) != 0) {
      return false;
    }
    const auto* x = reinterpret_cast<const char*>(&p.x);
    return reinterpret_cast<const char*>(&p.y) == x + sizeof(float) &&
           reinterpret_cast<const char*>(&p.z) == x + 2 * sizeof(float);
  }
  static const float* firstFloat(const PointT& p) {
    return reinterpret_cast<const float*>(&p.x);  // only called where x is a float
  }

  std::vector<float> copy_;
  PointView view_;
};

/// Normals of a PCL cloud as a PointView, in place (normal_x, normal_y, normal_z are consecutive in
/// every type that PCL_ADD_NORMAL4D made).
template <typename PointNT>
PointView normalView(const pcl::PointCloud<PointNT>& cloud) {
  PointView view;
  view.size = cloud.size();
  view.stride = sizeof(PointNT) / sizeof(float);
  if (!cloud.empty()) view.data = &cloud.points.front().normal_x;
  return view;
}

/// The same with curvatures.
template <typename PointNT>
NormalView curvedNormalView(const pcl::PointCloud<PointNT>& cloud) {
  if (cloud.empty()) return normalView(cloud);
  const PointNT& first = cloud.points.front();
  return {normalView(cloud), static_cast<std::size_t>(&first.curvature - &first.normal_x)};
}

}  // namespace segorient
