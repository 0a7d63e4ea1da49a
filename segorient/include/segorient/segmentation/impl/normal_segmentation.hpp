// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/common/colors.h>
#include <pcl/console/print.h>
#include <segorient/common/export.h>
#include <segorient/segmentation/normal_segmentation.h>
#include <segorient/common/impl/cloud_access.hpp>

#include <algorithm>

namespace segorient {

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::setInputCloud(const PointCloudConstPtr& cloud) {
  Base::setInputCloud(cloud);
  outdated();
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::setIndices(const pcl::IndicesPtr& indices) {
  Base::setIndices(indices);
  outdated();
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::setIndices(const pcl::IndicesConstPtr& indices) {
  // The base class copies without a look.
  Base::setIndices(indices ? pcl::IndicesPtr(new pcl::Indices(*indices)) : pcl::IndicesPtr());
  outdated();
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::setIndices(const pcl::PointIndicesConstPtr& indices) {
  Base::setIndices(indices ? pcl::IndicesPtr(new pcl::Indices(indices->indices))
                           : pcl::IndicesPtr());
  outdated();
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::setIndices(std::size_t row_start, std::size_t col_start,
                                                     std::size_t nb_rows, std::size_t nb_cols) {
  Base::setIndices(row_start, col_start, nb_rows, nb_cols);
  outdated();
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::setNeighborhoods(
    const std::shared_ptr<const Neighborhoods>& neighborhoods) {
  result_.clear();  // it may refer to the old table
  done_ = false;
  neighborhoods_ = neighborhoods;
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::setNumberOfNeighbours(unsigned int neighbors) {
  constexpr auto kMost = static_cast<unsigned int>(std::numeric_limits<int>::max() - 1);
  neighbors_ = std::min(neighbors, kMost);
  outdated();
}

template <typename PointT, typename NormalT>
CloudSegmentation::Search NormalSegmentation<PointT, NormalT>::searchFunction() {
  if (!search_) return {};
  // Unless it is on all of this cloud already. Indices may have changed in place since.
  if (!fake_indices_) {
    search_->setInputCloud(input_, indices_);
  } else if (search_->getInputCloud() != input_ || search_->getIndices()) {
    search_->setInputCloud(input_);
  }
  return [this](pcl::index_t point, int k, pcl::Indices& indices, std::vector<float>& distances) {
    return search_->nearestKSearch((*input_)[static_cast<std::size_t>(point)], k, indices,
                                   distances);
  };
}

template <typename PointT, typename NormalT>
bool NormalSegmentation<PointT, NormalT>::settingsAreGood() const {
  if (neighbors_ == 0) {
    PCL_ERROR("[segorient::NormalSegmentation] the number of neighbours is 0\n");
    return false;
  }
  if (residual_test_ && !(residual_ > 0.F)) {
    PCL_ERROR("[segorient::NormalSegmentation] the residual threshold (%g) is not above 0\n",
              static_cast<double>(residual_));
    return false;
  }
  return true;
}

template <typename PointT, typename NormalT>
bool NormalSegmentation<PointT, NormalT>::segment() {
  result_.clear();
  done_ = false;
  if (!initCompute()) {
    PCL_ERROR("[segorient::NormalSegmentation] no input cloud\n");
    return false;
  }
  bool good = settingsAreGood();
  if (!good) {
    // said already
  } else if (!normals_ || normals_->size() != input_->size()) {
    good = false;
    PCL_ERROR("[segorient::NormalSegmentation] %zu normals for %zu points\n",
              normals_ ? normals_->size() : std::size_t{0}, input_->size());
  } else {
    const CloudPoints<PointT> points(*input_);
    const CloudNormals<NormalT> normals(*normals_);
    CloudSegmentation::Input input;
    input.points = points.view();
    input.normals = normals.view();
    if (!fake_indices_) input.indices = indices_.get();
    input.table = neighborhoods_.get();
    input.neighbors = static_cast<int>(neighbors_);
    input.unite_smooth = unite_smooth_;
    if (!neighborhoods_ && !input_->empty()) input.search = searchFunction();
    SegmentationOptions options = options_;
    if (!curvature_test_) options.max_curvature = std::numeric_limits<float>::max();
    if (residual_test_) options.max_residual = residual_;
    good = result_.compute(input, options);
    if (!good)
      PCL_ERROR("[segorient::NormalSegmentation] empty cloud, or neighbourhoods of another\n");
  }
  deinitCompute();
  done_ = good;
  return good;
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::extract(std::vector<pcl::PointIndices>& clusters) {
  clusters.clear();
  if (!segment()) return;
  const Segmentation& s = result_.faces();
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    if (s.segments[i].size < min_size_ || s.segments[i].size > max_size_) continue;
    clusters.emplace_back();
    clusters.back().header = input_->header;
    clusters.back().indices.assign(s.begin(i), s.end(i));
  }
}

template <typename PointT, typename NormalT>
void NormalSegmentation<PointT, NormalT>::getSegmentFromPoint(pcl::index_t index,
                                                              pcl::PointIndices& cluster) {
  cluster.indices.clear();
  if (!done_ && !segment()) return;
  const Segmentation& s = result_.faces();
  cluster.header = input_->header;
  if (index < 0 || static_cast<std::size_t>(index) >= s.labels.size()) return;
  const std::int32_t label = s.labels[static_cast<std::size_t>(index)];
  if (label < 0) return;
  cluster.indices.assign(s.begin(static_cast<std::size_t>(label)),
                         s.end(static_cast<std::size_t>(label)));
}

template <typename PointT, typename NormalT>
template <typename ColoredT>
typename pcl::PointCloud<ColoredT>::Ptr NormalSegmentation<PointT, NormalT>::colored() const {
  if (!done_ || !input_) return {};
  typename pcl::PointCloud<ColoredT>::Ptr cloud(new pcl::PointCloud<ColoredT>);
  const std::vector<std::int32_t>& labels = getLabels();
  cloud->resize(input_->size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const PointT& from = (*input_)[i];
    ColoredT& to = (*cloud)[i];
    to.x = from.x;
    to.y = from.y;
    to.z = from.z;
    const pcl::RGB color =
        labels[i] < 0
            ? pcl::RGB(90, 90, 90)
            : pcl::GlasbeyLUT::at(static_cast<std::size_t>(labels[i]) % pcl::GlasbeyLUT::size());
    to.r = color.r;
    to.g = color.g;
    to.b = color.b;
    to.a = 255;
  }
  cloud->header = input_->header;
  cloud->width = input_->width;
  cloud->height = input_->height;
  cloud->is_dense = input_->is_dense;
  cloud->sensor_origin_ = input_->sensor_origin_;
  cloud->sensor_orientation_ = input_->sensor_orientation_;
  return cloud;
}

template <typename PointT, typename NormalT>
pcl::PointCloud<pcl::PointXYZRGB>::Ptr NormalSegmentation<PointT, NormalT>::getColoredCloud() {
  return colored<pcl::PointXYZRGB>();
}

template <typename PointT, typename NormalT>
pcl::PointCloud<pcl::PointXYZRGBA>::Ptr NormalSegmentation<PointT, NormalT>::getColoredCloudRGBA() {
  return colored<pcl::PointXYZRGBA>();
}

}  // namespace segorient

#define PCL_INSTANTIATE_NormalSegmentation(T, NT) \
  template class SEGORIENT_SEGMENTATION_EXPORT segorient::NormalSegmentation<T, NT>;
