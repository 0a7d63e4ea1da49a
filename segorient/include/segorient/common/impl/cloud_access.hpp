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
  CloudPoints(const CloudPoints&) = delete;  // the view may be of our own copy
  CloudPoints(CloudPoints&&) noexcept = default;
  CloudPoints& operator=(const CloudPoints&) = delete;
  CloudPoints& operator=(CloudPoints&&) noexcept = default;

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

/// Whether a point type has a curvature beside its normal.
template <typename PointNT, typename = void>
struct HasCurvature : std::false_type {};
template <typename PointNT>
struct HasCurvature<PointNT, std::void_t<decltype(PointNT::curvature)>> : std::true_type {};

/// Normals and curvatures of a PCL cloud as a NormalView: in place where normal_x, normal_y,
/// normal_z are consecutive floats in the point type and the curvature is a float behind them, as
/// in pcl::Normal and its like; otherwise as a copy that this object owns, with curvature 0 where
/// the type has none (pcl::Axis). Values are passed on as they are, NaN included; an empty cloud is
/// a view of no rows.
template <typename PointNT>
class CloudNormals {
 public:
  CloudNormals() = default;
  /// \param cloud must outlive this object
  explicit CloudNormals(const pcl::PointCloud<PointNT>& cloud) { assign(cloud); }
  CloudNormals(const CloudNormals&) = delete;  // the view may be of our own copy
  CloudNormals(CloudNormals&&) noexcept = default;
  CloudNormals& operator=(const CloudNormals&) = delete;
  CloudNormals& operator=(CloudNormals&&) noexcept = default;

  void assign(const pcl::PointCloud<PointNT>& cloud) {
    view_ = NormalView{};
    view_.size = cloud.size();
    if (cloud.empty()) return;
    if constexpr (HasCurvature<PointNT>::value) {
      const PointNT& first = cloud.points.front();
      if (inPlace(first)) {
        view_.data = reinterpret_cast<const float*>(&first.normal_x);
        view_.stride = sizeof(PointNT) / sizeof(float);
        view_.curvature =
            static_cast<std::size_t>(address(first.curvature) - address(first.normal_x)) /
            sizeof(float);
        return;
      }
    }
    copy_.resize(4 * cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      copy_[4 * i] = static_cast<float>(cloud[i].normal_x);
      copy_[4 * i + 1] = static_cast<float>(cloud[i].normal_y);
      copy_[4 * i + 2] = static_cast<float>(cloud[i].normal_z);
      copy_[4 * i + 3] = 0.F;
      if constexpr (HasCurvature<PointNT>::value) {
        copy_[4 * i + 3] = static_cast<float>(cloud[i].curvature);
      }
    }
    view_ = NormalView{copy_.data(), 4, cloud.size()};
  }

  const NormalView& view() const { return view_; }

 private:
  template <typename Member>
  static const char* address(const Member& member) {
    return reinterpret_cast<const char*>(&member);
  }
  static bool inPlace(const PointNT& p) {
    if (!std::is_same_v<std::decay_t<decltype(p.normal_x)>, float> ||
        !std::is_same_v<std::decay_t<decltype(p.curvature)>, float> ||
        sizeof(PointNT) % sizeof(float) != 0) {
      return false;
    }
    const std::ptrdiff_t to_curvature = address(p.curvature) - address(p.normal_x);
    return address(p.normal_y) == address(p.normal_x) + sizeof(float) &&
           address(p.normal_z) == address(p.normal_x) + 2 * sizeof(float) && to_curvature > 0 &&
           static_cast<std::size_t>(to_curvature) % sizeof(float) == 0;
  }

  std::vector<float> copy_;
  NormalView view_;
};

}  // namespace segorient
