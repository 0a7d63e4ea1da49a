// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/segmentation/impl/cloud_segmentation.hpp>

#include <algorithm>
#include <limits>

#include "common/bulk_bounds.h"
#include "common/refers_to.h"
#include "search/prepared_cloud.h"
#include "segmentation/region_growing.h"
#include "segmentation/segment_graph.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {
namespace {

void copyNormal(const NormalView& normals, std::size_t i, float* to) {
  std::copy_n(normals[i], 3, to);
  to[3] = normals[i][normals.curvature];
}

std::vector<float> copyOf(const PointView& points) {
  std::vector<float> out(3 * points.size);
  for (std::size_t i = 0; i < points.size; ++i) std::copy_n(points[i], 3, &out[3 * i]);
  return out;
}

// The points with NaN in the place of those beyond floats, which are then not chosen any more;
// empty where there are none.
std::vector<float> withoutStrays(const PointView& points, std::vector<bool>& chosen) {
  const Bounds bulk = bulkBounds(points);
  std::vector<float> out;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isFinite(points[i]) || !bulk.isBeyondFloats(inDouble(points[i]))) continue;
    if (out.empty()) out = copyOf(points);
    std::fill_n(&out[3 * i], 3, std::numeric_limits<float>::quiet_NaN());
    chosen[i] = false;
  }
  return out;
}

}  // namespace

void CloudSegmentation::clear() {
  result_ = Segmentation{};
  faces_ = Segmentation{};
  united_ = false;
  report_ = SegmentationReport{};
  table_ = nullptr;
  cloud_.reset();
}

bool CloudSegmentation::compute(const Input& input, const SegmentationOptions& options) {
  clear();
  if (input.normals.size != input.points.size || input.points.size == 0) return false;
  neighbors_ = std::max(input.neighbors, 1);
  united_ = input.unite_smooth;
  if (input.table != nullptr) return computeWithTable(input, options);
  computePrepared(input, options);
  return true;
}

bool CloudSegmentation::computeWithTable(const Input& input, const SegmentationOptions& options) {
  const std::size_t size = input.points.size;
  if (input.table->size() != size || !refersTo(*input.table, size)) return false;
  std::vector<bool> chosen(size, input.indices == nullptr);
  for (std::size_t i = 0; input.indices != nullptr && i < input.indices->size(); ++i) {
    const pcl::index_t row = (*input.indices)[i];
    if (row >= 0 && static_cast<std::size_t>(row) < size)
      chosen[static_cast<std::size_t>(row)] = true;
  }
  PointView points = input.points;
  const std::vector<float> without_strays = withoutStrays(input.points, chosen);
  if (!without_strays.empty()) points = {without_strays.data(), 3, size};
  NormalView normals = input.normals;
  std::vector<float> masked;
  if (std::find(chosen.begin(), chosen.end(), false) != chosen.end()) {
    masked.assign(4 * size, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < size; ++i) {
      if (chosen[i]) copyNormal(input.normals, i, &masked[4 * i]);
    }
    normals = {masked.data(), 4, size};
  }
  SegmentationOptions used = options;
  used.neighbors = neighbors_;
  table_ = input.table;
  result_ = segmentByNormals(points, normals, *table_, used, &report_, united_ ? &faces_ : nullptr);
  return true;
}

void CloudSegmentation::computePrepared(const Input& input, const SegmentationOptions& options) {
  cloud_ = std::make_shared<PreparedCloud>(input.points, input.indices, options.threads);
  cloud_->findNeighbors(neighbors_, input.search);
  cloud_->dropIndex();
  const std::vector<float> normals = segmentation::gatherNormals(*cloud_, input.normals);
  SegmentationOptions used = segmentation::inUnitOf(*cloud_, options);
  used.neighbors = neighbors_;
  Segmentation faces;
  const Segmentation segments =
      segmentByNormals(cloud_->points(), {normals.data(), 4, cloud_->size()},
                       cloud_->neighborhoods(), used, &report_, united_ ? &faces : nullptr);
  result_ = segmentation::scatter(*cloud_, segments, &input.normals);
  if (united_) faces_ = segmentation::scatter(*cloud_, faces, &input.normals);
}

const Neighborhoods& CloudSegmentation::table() const {
  return table_ != nullptr ? *table_ : cloud_->neighborhoods();
}

// The input row of a row of the table.
std::size_t CloudSegmentation::rowOf(pcl::index_t point) const {
  const auto i = static_cast<std::size_t>(point);
  return table_ != nullptr ? i : cloud_->rowOf(i);
}

std::vector<float> CloudSegmentation::confidences() const {
  const std::vector<std::int32_t>& labels = faces().labels;
  std::vector<float> result(labels.size(), 0.F);
  if (labels.empty()) return result;
  for (std::size_t i = 0; i < table().size(); ++i) {
    const std::size_t row = rowOf(static_cast<pcl::index_t>(i));
    const int count = std::min(table().count(i), neighbors_ + 1);
    if (labels[row] < 0 || count < 2) continue;
    int same = 0;
    for (int j = 1; j < count; ++j) same += labels[rowOf(table().indices(i)[j])] == labels[row];
    result[row] = static_cast<float>(same) / static_cast<float>(count - 1);
  }
  // Exact duplicates have what the first of them has.
  for (std::size_t row = 0; table_ == nullptr && row < result.size(); ++row) {
    if (cloud_->pointOf(row) >= 0) result[row] = result[rowOf(cloud_->pointOf(row))];
  }
  return result;
}

SegmentGraph CloudSegmentation::graph() const {
  if (result_.labels.empty()) return {};
  if (table_ != nullptr) return buildSegmentGraph(result_, *table_, neighbors_);
  Segmentation of_points;
  of_points.segments.resize(result_.segments.size());
  of_points.labels.reserve(cloud_->size());
  for (std::size_t i = 0; i < cloud_->size(); ++i) {
    of_points.labels.push_back(result_.labels[cloud_->rowOf(i)]);
  }
  SegmentGraph graph = buildSegmentGraph(of_points, cloud_->neighborhoods(), neighbors_);
  for (BorderPair& pair : graph.pairs) {
    pair.in_a = static_cast<pcl::index_t>(rowOf(pair.in_a));
    pair.in_b = static_cast<pcl::index_t>(rowOf(pair.in_b));
  }
  return graph;
}

}  // namespace segorient
