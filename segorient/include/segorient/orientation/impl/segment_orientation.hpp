// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/console/print.h>
#include <segorient/common/export.h>
#include <segorient/orientation/segment_orientation.h>
#include <segorient/common/impl/cloud_access.hpp>
#include <segorient/common/impl/copy_place.hpp>
#include <segorient/orientation/impl/cloud_hints.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace segorient {

template <typename PointT, typename NormalT>
PointSearch SegmentOrientation<PointT, NormalT>::searchFunction() {
  if (neighborhoods_) {
    return [this](pcl::index_t point, int k, pcl::Indices& indices, std::vector<float>&) {
      const auto row = static_cast<std::size_t>(point);
      const int count = std::min(k, neighborhoods_->count(row));
      std::copy_n(neighborhoods_->indices(row), count, indices.begin());
      return count;
    };
  }
  if (!search_) return {};
  if (search_->getInputCloud() != input_ || search_->getIndices()) search_->setInputCloud(input_);
  return
      [this](pcl::index_t point, int k, pcl::Indices& indices, std::vector<float>& sqr_distances) {
        return search_->nearestKSearch((*input_)[static_cast<std::size_t>(point)], k, indices,
                                       sqr_distances);
      };
}

// The point itself not counted; 0 = as many as the method asks for.
template <typename PointT, typename NormalT>
int SegmentOrientation<PointT, NormalT>::otherNeighbors() const {
  if (k_ > 0) return std::max(1, k_ - 1);
  return neighborhoods_ ? std::max(1, neighborhoods_->k() - 1) : 0;
}

template <typename PointT, typename NormalT>
bool SegmentOrientation<PointT, NormalT>::orient() {
  if (!input_ || input_->empty()) {
    PCL_ERROR(
        "[segorient::SegmentOrientation::compute] There is no input cloud, or it is empty.\n");
    return false;
  }
  if (!normals_ || normals_->size() != input_->size()) {
    PCL_ERROR("[segorient::SegmentOrientation::compute] There must be one normal a point.\n");
    return false;
  }
  if (k_ < 0) {
    PCL_ERROR("[segorient::SegmentOrientation::compute] k (%d) must not be negative.\n", k_);
    return false;
  }
  if (neighborhoods_ && !isTableOf(*neighborhoods_, input_->size())) {
    PCL_ERROR(
        "[segorient::SegmentOrientation::compute] The neighbourhoods are not those of this "
        "cloud.\n");
    return false;
  }
  const CloudPoints<PointT> points(*input_);
  const CloudNormals<NormalT> normals(*normals_);
  auto hints = std::make_shared<OrientationHints>(hints_);
  detail::addViewpoints(*input_, *hints);
  if (keep_orientation_) detail::addNormals(*normals_, *hints);
  if (seeds_) detail::addSeeds(*seeds_, *hints);
  OrientationOptions options = options_;
  if (!options.hints) options.hints = hints;
  SegmentationOptions segmentation_options{segmentation_options_};
  segmentation_options.threads = options.threads;
  for (const std::string& name :
       settingsWithoutEffect(segmentation_options_, options, segmentation_ != nullptr)) {
    PCL_WARN("[segorient::SegmentOrientation::compute] %s changes nothing with method %s%s.\n",
             name.c_str(), toString(options.method), segmentation_ ? " and given segments" : "");
  }
  result_ = orientSegmentation(points.view(), normals.view(), segmentation_.get(), otherNeighbors(),
                               segmentation_options, options, searchFunction());
  if (result_.orientation.point_signs.empty()) {
    PCL_ERROR(
        "[segorient::SegmentOrientation::compute] The segments are not those of this cloud.\n");
    return false;
  }
  return true;
}

template <typename PointT, typename NormalT>
void SegmentOrientation<PointT, NormalT>::compute(PointCloudN& output) {
  PointCloudN oriented;  // the output may be the input
  result_ = OrientedSegmentation{};
  if (orient() && initCompute()) {
    oriented.header = input_->header;
    oriented.is_dense = true;
    for (const pcl::index_t index : *indices_) {
      const auto i = static_cast<std::size_t>(index);
      const bool in_range = index >= 0 && i < normals_->size();
      NormalT normal = in_range ? (*normals_)[i] : NormalT();
      const int sign = in_range ? result_.orientation.point_signs[i] : 0;
      const float factor =
          sign != 0 ? static_cast<float>(sign) : std::numeric_limits<float>::quiet_NaN();
      normal.normal_x *= factor;
      normal.normal_y *= factor;
      normal.normal_z *= factor;
      copyPlace(*input_, index, normal);
      if (sign == 0) oriented.is_dense = false;
      oriented.push_back(normal);
    }
    if (oriented.size() == input_->size() && input_->isOrganized()) {
      oriented.width = input_->width;
      oriented.height = input_->height;
    }
    deinitCompute();
  }
  output = oriented;
}

}  // namespace segorient

#define PCL_INSTANTIATE_SegmentOrientation(T, NT) \
  template class SEGORIENT_ORIENTATION_EXPORT segorient::SegmentOrientation<T, NT>;
