// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/console/print.h>
#include <segorient/common/export.h>
#include <segorient/features/local_normal_estimation.h>
#include <segorient/common/impl/cloud_access.hpp>
#include <segorient/common/impl/copy_place.hpp>
#include <segorient/common/impl/point_search.hpp>
#include <segorient/features/impl/searched_normals.hpp>

#include <algorithm>
#include <cmath>

namespace segorient {

template <typename PointInT, typename PointOutT>
LocalNormalEstimation<PointInT, PointOutT>::LocalNormalEstimation(const char* name,
                                                                  NormalEstimator estimator,
                                                                  unsigned int threads) {
  feature_name_ = name;
  options_.estimator = estimator;
  setNumberOfThreads(threads);
}

template <typename PointInT, typename PointOutT>
void LocalNormalEstimation<PointInT, PointOutT>::setInputCloud(const PointCloudConstPtr& cloud) {
  // PCL reads the sensor origin without looking whether there is a cloud.
  if (cloud) {
    Base::setInputCloud(cloud);
  } else {
    input_.reset();
  }
}

template <typename PointInT, typename PointOutT>
bool LocalNormalEstimation<PointInT, PointOutT>::initCompute() {
  curvatures_.clear();
  if (!input_ || input_->empty()) {
    PCL_ERROR("[segorient::%s::compute] There is no input cloud, or it is empty.\n",
              getClassName().c_str());
    return false;
  }
  const bool by_radius = search_radius_ != 0.0;
  if (k_ < 0 || (by_radius && !(search_radius_ > 0.0))) {
    PCL_ERROR("[segorient::%s::compute] k (%d) and radius (%g) must not be negative.\n",
              getClassName().c_str(), k_, search_radius_);
    return false;
  }
  if ((by_radius && k_ != 0) || (!by_radius && k_ == 0 && !neighborhoods_)) {
    PCL_ERROR("[segorient::%s::compute] Set either k (%d) or a radius (%g).\n",
              getClassName().c_str(), k_, search_radius_);
    return false;
  }
  if (!pcl::PCLBase<PointInT>::initCompute()) return false;
  if (!surface_) {
    fake_surface_ = true;
    surface_ = input_;
  }
  // Without a search method no tree of PCL's is built: see estimate().
  if (!tree_ || neighborhoods_) return true;
  if (tree_->getInputCloud() != surface_) tree_->setInputCloud(surface_);
  search_parameter_ = by_radius ? search_radius_ : k_;
  search_method_surface_ = [this, by_radius](const pcl::PointCloud<PointInT>& cloud,
                                             std::size_t index, double parameter,
                                             pcl::Indices& indices, std::vector<float>& distances) {
    const auto i = static_cast<pcl::index_t>(index);
    if (by_radius) {
      makeRoomForSearch(0, indices, distances);
      return keepFound(tree_->radiusSearch(cloud, i, parameter, indices, distances), indices,
                       distances);
    }
    const auto k = static_cast<int>(std::min(parameter, static_cast<double>(surface_->size())));
    makeRoomForSearch(k, indices, distances);
    return keepFound(tree_->nearestKSearch(cloud, i, k, indices, distances), indices, distances);
  };
  return true;
}

template <typename PointInT, typename PointOutT>
bool LocalNormalEstimation<PointInT, PointOutT>::estimate(std::vector<float>& normals) {
  const CloudPoints<PointInT> input(*input_);
  const bool own_surface = surface_ == input_;
  CloudPoints<PointInT> other;
  if (!own_surface) other.assign(*surface_);
  const PointView& surface = own_surface ? input.view() : other.view();
  LocalCurvature* curvatures = keep_curvatures_ ? curvatures_.data() : nullptr;
  LocalNormalOptions options = options_;
  options.k = k_ > 0 ? std::max(k_ - 1, 1) : 0;

  if (neighborhoods_) {
    return estimateNormalsFromTable(input.view(), *indices_, surface, *neighborhoods_, options,
                                    normals.data(), curvatures);
  }
  if (!tree_) {
    searchAndEstimateNormals(input.view(), *indices_, own_surface ? nullptr : &surface,
                             {k_, search_radius_}, options, normals.data(), curvatures);
    return true;
  }
  const NeighborSearch search = [this](pcl::index_t index, pcl::Indices& indices,
                                       std::vector<float>& distances) {
    return this->searchForNeighbors(static_cast<std::size_t>(index), search_parameter_, indices,
                                    distances);
  };
  searchAndEstimateNormals(input.view(), *indices_, surface, search, options, normals.data(),
                           curvatures);
  return true;
}

template <typename PointInT, typename PointOutT>
void LocalNormalEstimation<PointInT, PointOutT>::write(const std::vector<float>& normals,
                                                       PointCloudOut& output) {
  for (std::size_t i = 0; i < indices_->size(); ++i) {
    const float* n = &normals[4 * i];
    PointOutT& out = output[i];
    const auto index = static_cast<std::size_t>((*indices_)[i]);
    const bool in_range = (*indices_)[i] >= 0 && index < input_->size();
    copyPlace(*input_, (*indices_)[i], out);
    out.normal_x = n[0];
    out.normal_y = n[1];
    out.normal_z = n[2];
    out.curvature = n[3];
    if (!std::isfinite(n[0]) || !in_range) {
      output.is_dense = false;
      continue;
    }
    pcl::flipNormalTowardsViewpoint((*input_)[index], this->vpx_, this->vpy_, this->vpz_,
                                    out.normal_x, out.normal_y, out.normal_z);
    const bool flipped = out.normal_x * n[0] + out.normal_y * n[1] + out.normal_z * n[2] < 0.0F;
    if (flipped && keep_curvatures_) {
      curvatures_[i].pc1 = -curvatures_[i].pc1;
      curvatures_[i].pc2 = -curvatures_[i].pc2;
    }
  }
}

template <typename PointInT, typename PointOutT>
void LocalNormalEstimation<PointInT, PointOutT>::computeFeature(PointCloudOut& output) {
  output.is_dense = true;
  std::vector<float> normals(4 * indices_->size());
  curvatures_.resize(keep_curvatures_ ? indices_->size() : 0);
  if (neighborhoods_ && search_radius_ != 0.0) {
    PCL_WARN("[segorient::%s::compute] The radius changes nothing with ready neighbourhoods.\n",
             getClassName().c_str());
  }
  if (!estimate(normals)) {
    PCL_ERROR("[segorient::%s::compute] The neighbourhoods are not those of this cloud.\n",
              getClassName().c_str());
    curvatures_.clear();
    output.clear();
    output.width = output.height = 0;
    return;
  }
  write(normals, output);
}

}  // namespace segorient

#define PCL_INSTANTIATE_LocalNormalEstimation(T, NT) \
  template class SEGORIENT_FEATURES_EXPORT segorient::LocalNormalEstimation<T, NT>;
