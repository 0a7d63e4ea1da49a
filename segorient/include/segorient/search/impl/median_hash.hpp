// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/console/print.h>
#include <pcl/point_representation.h>
#include <segorient/common/export.h>
#include <segorient/search/median_hash.h>
#include <pcl/search/impl/kdtree.hpp>
#include <segorient/common/impl/cloud_access.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <typeinfo>

namespace segorient::search {

template <typename PointT>
MedianHash<PointT>::MedianHash(bool sorted) : Base(sorted) {
  this->name_ = "MedianHash";
}

template <typename PointT>
void MedianHash<PointT>::setNumberOfThreads(unsigned int threads) {
  constexpr auto kMost = static_cast<unsigned int>(std::numeric_limits<int>::max());
  options_.threads = static_cast<int>(std::min(threads, kMost));
  index_.setNumberOfThreads(options_.threads);
}

template <typename PointT>
typename MedianHash<PointT>::Access MedianHash<PointT>::chooseAccess() const {
  const auto& used = *representation_;
  if (used.getNumberOfDimensions() > 3) return Access::kPcl;
  const bool plain = typeid(used) == typeid(pcl::DefaultPointRepresentation<PointT>);
  return plain && used.isTrivial() ? Access::kXYZ : Access::kRepresentation;
}

template <typename PointT>
void MedianHash<PointT>::setPointRepresentation(
    const typename Base::PointRepresentationConstPtr& representation) {
  Base::setPointRepresentation(representation);
  if (this->input_) build(this->input_, this->indices_);
}

template <typename PointT>
typename MedianHash<PointT>::InputResult MedianHash<PointT>::setInputCloud(
    const PointCloudConstPtr& cloud, const IndicesConstPtr& indices) {
  this->input_ = cloud;
  this->indices_ = indices;
  return static_cast<InputResult>(build(cloud, indices));
}

template <typename PointT>
bool MedianHash<PointT>::build(const PointCloudConstPtr& cloud, const IndicesConstPtr& indices) {
  index_ = MedianHashIndex();
  access_ = Access::kNone;
  if (!cloud || cloud->empty()) {
    PCL_ERROR("[segorient::MedianHash::setInputCloud] The input cloud is %s!\n",
              cloud ? "empty" : "null");
    return false;
  }
  if (cloud->size() > MedianHashIndex::kMostPoints) {
    PCL_ERROR("[segorient::MedianHash::setInputCloud] The input cloud is too large!\n");
    return false;
  }
  representation_ = this->getPointRepresentation();
  access_ = chooseAccess();
  if (access_ == Access::kPcl) {
    // PCL's tree reads what indices name without a check, and cannot be searched without a point.
    const auto inCloud = [&](pcl::index_t i) {
      return i >= 0 && static_cast<std::size_t>(i) < cloud->size();
    };
    const auto usable = [&](pcl::index_t i) {
      return representation_->isValid((*cloud)[static_cast<std::size_t>(i)]);
    };
    bool any = false;
    if (indices) {
      if (!std::all_of(indices->begin(), indices->end(), inCloud)) {
        PCL_ERROR("[segorient::MedianHash::setInputCloud] An index is out of range!\n");
        access_ = Access::kNone;
        return false;
      }
      any = std::any_of(indices->begin(), indices->end(), usable);
    } else {
      any = std::any_of(cloud->begin(), cloud->end(),
                        [&](const PointT& p) { return representation_->isValid(p); });
    }
    if (!any) {
      access_ = Access::kNone;
      return false;
    }
    this->tree_->setInputCloud(cloud, indices);
    return true;
  }
  if (access_ == Access::kXYZ) {
    const CloudPoints<PointT> points(*cloud);
    index_.build(points.view(), indices.get(), options_);
  } else {
    std::vector<float> points(3 * cloud->size());
    for (std::size_t i = 0; i < cloud->size(); ++i) toFloats((*cloud)[i], &points[3 * i]);
    index_.build({points.data(), 3, cloud->size()}, indices.get(), options_);
  }
  return index_.size() > 0;
}

// False where the point cannot be searched for.
template <typename PointT>
bool MedianHash<PointT>::toFloats(const PointT& point, float* out) const {
  if (access_ == Access::kXYZ) {
    out[0] = static_cast<float>(point.x);
    out[1] = static_cast<float>(point.y);
    out[2] = static_cast<float>(point.z);
  } else {
    std::array<float, 3> values{};
    representation_->vectorize(point, values);
    std::copy(values.begin(), values.end(), out);
  }
  return isFinite(out);
}

// Null where a query by index has no point to ask for.
template <typename PointT>
const PointT* MedianHash<PointT>::inputPoint(pcl::index_t index) const {
  if (!this->input_ || index < 0) return nullptr;
  auto at = static_cast<std::size_t>(index);
  if (this->indices_) {
    if (at >= this->indices_->size()) return nullptr;
    at = static_cast<std::size_t>((*this->indices_)[at]);
  }
  return at < this->input_->size() ? &(*this->input_)[at] : nullptr;
}

template <typename PointT>
int MedianHash<PointT>::nearestKSearch(const PointT& point, int k, Indices& k_indices,
                                       std::vector<float>& k_sqr_distances) const {
  if (access_ == Access::kPcl && k > 0 && representation_->isValid(point)) {
    return this->tree_->nearestKSearch(point, static_cast<unsigned int>(k), k_indices,
                                       k_sqr_distances);
  }
  std::array<float, 3> query{};
  const bool searchable = (access_ == Access::kXYZ || access_ == Access::kRepresentation) &&
                          k > 0 && toFloats(point, query.data());
  const std::size_t found = searchable ? std::min(static_cast<std::size_t>(k), index_.size()) : 0;
  k_indices.resize(found);
  k_sqr_distances.resize(found);
  return index_.nearestK(query.data(), static_cast<int>(found), k_indices.data(),
                         k_sqr_distances.data(), this->getEpsilon());
}

template <typename PointT>
int MedianHash<PointT>::nearestKSearch(const PointCloud& cloud, pcl::index_t index, int k,
                                       Indices& k_indices,
                                       std::vector<float>& k_sqr_distances) const {
  if (index < 0 || static_cast<std::size_t>(index) >= cloud.size()) {
    k_indices.clear();
    k_sqr_distances.clear();
    return 0;
  }
  return nearestKSearch(cloud[static_cast<std::size_t>(index)], k, k_indices, k_sqr_distances);
}

template <typename PointT>
int MedianHash<PointT>::nearestKSearch(pcl::index_t index, int k, Indices& k_indices,
                                       std::vector<float>& k_sqr_distances) const {
  if (const PointT* point = inputPoint(index)) {
    return nearestKSearch(*point, k, k_indices, k_sqr_distances);
  }
  k_indices.clear();
  k_sqr_distances.clear();
  return 0;
}

// The points of a batch in a row, NaN where an index is out of range.
template <typename PointT>
std::vector<float> MedianHash<PointT>::batchQueries(const PointCloud& cloud,
                                                    const Indices& indices) const {
  const std::size_t count = indices.empty() ? cloud.size() : indices.size();
  std::vector<float> queries(3 * count, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = indices.empty() ? i : static_cast<std::size_t>(indices[i]);
    if (at < cloud.size()) toFloats(cloud[at], &queries[3 * i]);
  }
  return queries;
}

template <typename PointT>
void MedianHash<PointT>::nearestKSearch(const PointCloud& cloud, const Indices& indices, int k,
                                        std::vector<Indices>& k_indices,
                                        std::vector<std::vector<float>>& k_sqr_distances) const {
  if (access_ == Access::kXYZ || access_ == Access::kRepresentation) {
    const std::vector<float> queries = batchQueries(cloud, indices);
    index_.nearestKBatch({queries.data(), 3, queries.size() / 3}, k, k_indices, k_sqr_distances,
                         this->getEpsilon());
    return;
  }
  const std::size_t count = indices.empty() ? cloud.size() : indices.size();
  k_indices.resize(count);
  k_sqr_distances.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = indices.empty() ? static_cast<pcl::index_t>(i) : indices[i];
    nearestKSearch(cloud, index, k, k_indices[i], k_sqr_distances[i]);
  }
}

template <typename PointT>
int MedianHash<PointT>::radiusSearch(const PointT& point, double radius, Indices& k_indices,
                                     std::vector<float>& k_sqr_distances,
                                     unsigned int max_nn) const {
  k_indices.clear();
  k_sqr_distances.clear();
  if (access_ == Access::kNone) return 0;
  if (access_ == Access::kPcl) {
    if (!(radius > 0.0) || !representation_->isValid(point)) return 0;
    return this->tree_->radiusSearch(point, radius, k_indices, k_sqr_distances, max_nn);
  }
  std::array<float, 3> query{};
  if (!toFloats(point, query.data())) return 0;
  return index_.radius(query.data(), radius, k_indices, k_sqr_distances, max_nn,
                       this->sorted_results_);
}

template <typename PointT>
int MedianHash<PointT>::radiusSearch(const PointCloud& cloud, pcl::index_t index, double radius,
                                     Indices& k_indices, std::vector<float>& k_sqr_distances,
                                     unsigned int max_nn) const {
  if (index < 0 || static_cast<std::size_t>(index) >= cloud.size()) {
    k_indices.clear();
    k_sqr_distances.clear();
    return 0;
  }
  return radiusSearch(cloud[static_cast<std::size_t>(index)], radius, k_indices, k_sqr_distances,
                      max_nn);
}

template <typename PointT>
int MedianHash<PointT>::radiusSearch(pcl::index_t index, double radius, Indices& k_indices,
                                     std::vector<float>& k_sqr_distances,
                                     unsigned int max_nn) const {
  if (const PointT* point = inputPoint(index)) {
    return radiusSearch(*point, radius, k_indices, k_sqr_distances, max_nn);
  }
  k_indices.clear();
  k_sqr_distances.clear();
  return 0;
}

template <typename PointT>
void MedianHash<PointT>::radiusSearch(const PointCloud& cloud, const Indices& indices,
                                      double radius, std::vector<Indices>& k_indices,
                                      std::vector<std::vector<float>>& k_sqr_distances,
                                      unsigned int max_nn) const {
  if (access_ == Access::kXYZ || access_ == Access::kRepresentation) {
    const std::vector<float> queries = batchQueries(cloud, indices);
    index_.radiusBatch({queries.data(), 3, queries.size() / 3}, radius, k_indices, k_sqr_distances,
                       max_nn, this->sorted_results_);
    return;
  }
  const std::size_t count = indices.empty() ? cloud.size() : indices.size();
  k_indices.resize(count);
  k_sqr_distances.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = indices.empty() ? static_cast<pcl::index_t>(i) : indices[i];
    radiusSearch(cloud, index, radius, k_indices[i], k_sqr_distances[i], max_nn);
  }
}

// PCL's kd-tree has no search for all points.
template <typename PointT>
void MedianHash<PointT>::checkSearchAll(const char* method) const {
  if (access_ != Access::kPcl) return;
  PCL_ERROR(
      "[segorient::MedianHash::%s] The point representation has more than three dimensions!\n",
      method);
}

template <typename PointT>
void MedianHash<PointT>::nearestKSearchAll(int k, Neighborhoods& out, bool with_distances) const {
  checkSearchAll("nearestKSearchAll");
  index_.nearestKAll(k, out, with_distances, this->getEpsilon());
}

template <typename PointT>
void MedianHash<PointT>::radiusSearchAll(double radius, RadiusNeighborhoods& out,
                                         unsigned int max_nn, bool with_distances) const {
  checkSearchAll("radiusSearchAll");
  index_.radiusAll(radius, out, max_nn, with_distances);
}

}  // namespace segorient::search

#define PCL_INSTANTIATE_MedianHash(T) \
  template class SEGORIENT_SEARCH_EXPORT segorient::search::MedianHash<T>;
