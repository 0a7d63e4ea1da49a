// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/console/print.h>
#include <segorient/common/export.h>
#include <segorient/orientation/oriented_normal_estimation.h>
#include <segorient/common/impl/cloud_access.hpp>
#include <segorient/common/impl/copy_place.hpp>
#include <segorient/orientation/impl/cloud_hints.hpp>
#include <segorient/search/impl/median_neighbors.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

namespace segorient {

template <typename PointInT, typename PointOutT>
void OrientedNormalEstimation<PointInT, PointOutT>::setInputCloud(const PointCloudConstPtr& cloud) {
  // PCL reads the sensor origin without looking whether there is a cloud.
  if (cloud) {
    Base::setInputCloud(cloud);
  } else {
    input_.reset();
  }
}

template <typename PointInT, typename PointOutT>
bool OrientedNormalEstimation<PointInT, PointOutT>::initCompute() {
  result_ = OrientedCloud{};
  if (!input_ || input_->empty()) {
    PCL_ERROR("[segorient::%s::compute] There is no input cloud, or it is empty.\n",
              getClassName().c_str());
    return false;
  }
  if (k_ < 0) {
    PCL_ERROR("[segorient::%s::compute] k (%d) must not be negative.\n", getClassName().c_str(),
              k_);
    return false;
  }
  if (search_radius_ != 0.0 && (!(search_radius_ > 0.0) || k_ != 0)) {
    PCL_ERROR("[segorient::%s::compute] Set k (%d), or a radius (%g) above 0, or neither.\n",
              getClassName().c_str(), k_, search_radius_);
    return false;
  }
  if (!pcl::PCLBase<PointInT>::initCompute()) return false;
  if (!surface_) {
    fake_surface_ = true;
    surface_ = input_;
  }
  return true;
}

template <typename PointInT, typename PointOutT>
OrientationHints OrientedNormalEstimation<PointInT, PointOutT>::gatherHints(
    const pcl::PointCloud<PointInT>& cloud) const {
  OrientationHints hints;
  hints.surface = surface_kind_;
  // The base class takes the sensor origin, 0 where it is not known, until it is told otherwise.
  hints.has_viewpoint = !use_sensor_origin_ || vpx_ != 0.F || vpy_ != 0.F || vpz_ != 0.F;
  hints.viewpoint = {vpx_, vpy_, vpz_};
  hints.has_direction = has_direction_;
  hints.direction = direction_;
  hints.scans = scans_;
  detail::addViewpoints(cloud, hints);
  // Where a surface and the input are joined, or the caller has put points together, there is none.
  if (&cloud == input_.get()) detail::addGrid(cloud, hints);
  if (keep_orientation_) detail::addNormals(cloud, hints);
  if (seeds_) detail::addSeeds(*seeds_, hints);
  return hints;
}

template <typename PointInT, typename PointOutT>
void OrientedNormalEstimation<PointInT, PointOutT>::computeFeature(PointCloudOut& output) {
  try {
    estimate(output);
  } catch (...) {  // of setProgress(), or out of memory: the next cloud has a surface of its own
    this->deinitCompute();
    throw;
  }
}

template <typename PointInT, typename PointOutT>
void OrientedNormalEstimation<PointInT, PointOutT>::warnOfUnused(PipelineOptions options) const {
  // The sensor origin of a cloud was not set by anybody.
  const bool heeds_hints = options.orientation.method == OrientationMethod::AUTO;
  if (!heeds_hints && !options_.orientation.hints && use_sensor_origin_) {
    auto set = std::make_shared<OrientationHints>(*options.orientation.hints);
    set->has_viewpoint = false;
    options.orientation.hints = set;
  }
  if (keep_orientation_ && !pcl::traits::has_normal<PointInT>::value) {
    PCL_WARN("[segorient::%s::compute] The points have no normals whose orientation to keep.\n",
             getClassName().c_str());
  }
  for (const std::string& name : settingsWithoutEffect(options)) {
    PCL_WARN("[segorient::%s::compute] %s changes nothing with method %s.\n",
             getClassName().c_str(), name.c_str(), toString(options.orientation.method));
  }
}

template <typename PointInT, typename PointOutT>
void OrientedNormalEstimation<PointInT, PointOutT>::estimate(PointCloudOut& output) {
  PipelineOptions options = options_;
  if (k_ > 0) options.k = k_ > 1 ? k_ - 1 : 1;
  pcl::Indices rows = *indices_;
  pcl::PointCloud<PointInT> joined;
  const bool own_surface = surface_ == input_;
  if (!own_surface) {  // the input's points follow the surface's; those in both are merged
    joined = *surface_;
    for (pcl::index_t& row : rows) {
      const bool valid = row >= 0 && static_cast<std::size_t>(row) < input_->size();
      if (valid) joined.push_back((*input_)[static_cast<std::size_t>(row)]);
      row = valid ? static_cast<pcl::index_t>(joined.size() - 1) : -1;
    }
  }
  const pcl::PointCloud<PointInT>& cloud = own_surface ? *input_ : joined;
  if (!options.orientation.hints) {
    options.orientation.hints = std::make_shared<OrientationHints>(gatherHints(cloud));
  }
  warnOfUnused(options);
  const CloudPoints<PointInT> points(cloud);
  if (search_radius_ > 0.0) {
    options.k =
        std::max(1, search::medianNeighborsWithin(points.view(), search_radius_, options.threads));
  }
  result_ = orientCloud(points.view(), nullptr, options, progress_);
  const bool whole = own_surface && this->fake_indices_;
  if (!whole) result_ = selectRows(result_, rows);
  write(output);
}

template <typename PointInT, typename PointOutT>
void OrientedNormalEstimation<PointInT, PointOutT>::write(PointCloudOut& output) const {
  output.is_dense = true;
  for (std::size_t i = 0; i < indices_->size(); ++i) {
    PointOutT& out = output[i];
    const float* n = &result_.normals[4 * i];
    copyPlace(*input_, (*indices_)[i], out);
    out.normal_x = n[0];
    out.normal_y = n[1];
    out.normal_z = n[2];
    out.curvature = n[3];
    if (!std::isfinite(n[0])) output.is_dense = false;
  }
}

}  // namespace segorient

#define PCL_INSTANTIATE_OrientedNormalEstimation(T, NT) \
  template class SEGORIENT_ORIENTATION_EXPORT segorient::OrientedNormalEstimation<T, NT>;
