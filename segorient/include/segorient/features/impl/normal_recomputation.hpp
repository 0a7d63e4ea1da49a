// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/console/print.h>
#include <segorient/common/export.h>
#include <segorient/features/normal_recomputation.h>
#include <segorient/common/impl/cloud_access.hpp>
#include <segorient/common/impl/copy_place.hpp>
#include <segorient/features/impl/cloud_recomputation.hpp>

#include <cmath>
#include <limits>

namespace segorient {

template <typename PointT, typename NormalT>
bool NormalRecomputation<PointT, NormalT>::checkInput() const {
  if (!input_ || input_->empty()) {
    PCL_ERROR(
        "[segorient::NormalRecomputation::compute] There is no input cloud, or it is empty.\n");
    return false;
  }
  if (!normals_ || normals_->size() != input_->size() || labels_.size() != input_->size()) {
    PCL_ERROR(
        "[segorient::NormalRecomputation::compute] The cloud has %zu points, and there are %zu "
        "normals and %zu labels.\n",
        input_->size(), normals_ ? normals_->size() : 0, labels_.size());
    return false;
  }
  if (neighborhoods_ && neighborhoods_->size() != input_->size()) {
    PCL_ERROR(
        "[segorient::NormalRecomputation::compute] The neighbourhoods are those of %zu points, "
        "not of %zu.\n",
        neighborhoods_->size(), input_->size());
    return false;
  }
  return true;
}

template <typename PointT, typename NormalT>
void NormalRecomputation<PointT, NormalT>::compute(Normals& output) {
  report_ = {};
  moved_labels_ = labels_;
  Normals sharper;  // the output may be the input
  if (checkInput() && this->initCompute()) recompute(sharper);
  output = sharper;
}

template <typename PointT, typename NormalT>
void NormalRecomputation<PointT, NormalT>::recompute(Normals& output) {
  const CloudPoints<PointT> points(*input_);
  std::vector<float> normals(4 * input_->size());
  for (std::size_t i = 0; i < input_->size(); ++i) {
    const NormalT& n = (*normals_)[i];
    normals[4 * i] = n.normal_x;
    normals[4 * i + 1] = n.normal_y;
    normals[4 * i + 2] = n.normal_z;
    normals[4 * i + 3] = n.curvature;
  }
  report_ = recomputeCloudNormals(points.view(), *indices_, neighborhoods_.get(), regular_,
                                  options_, rounds_, moved_labels_, normals);

  output.header = input_->header;
  output.resize(indices_->size());
  output.is_dense = true;
  for (std::size_t i = 0; i < indices_->size(); ++i) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const pcl::index_t index = (*indices_)[i];
    const bool in_range = index >= 0 && static_cast<std::size_t>(index) < input_->size();
    const auto from = static_cast<std::size_t>(index);
    if (in_range) output[i] = (*normals_)[from];
    copyPlace(*input_, index, output[i]);
    output[i].normal_x = in_range ? normals[4 * from] : kNaN;
    output[i].normal_y = in_range ? normals[4 * from + 1] : kNaN;
    output[i].normal_z = in_range ? normals[4 * from + 2] : kNaN;
    if (!std::isfinite(output[i].normal_x)) output.is_dense = false;
  }
  if (indices_->size() == input_->size() && input_->width * input_->height == input_->size()) {
    output.width = input_->width;
    output.height = input_->height;
  }
  this->deinitCompute();
}

}  // namespace segorient

#define PCL_INSTANTIATE_NormalRecomputation(T, NT) \
  template class SEGORIENT_FEATURES_EXPORT segorient::NormalRecomputation<T, NT>;
