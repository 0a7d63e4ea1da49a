// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/compact_cloud.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/segmentation/cloud_segmentation.h>

#include <algorithm>
#include <limits>
#include <type_traits>

#include "segment_order.h"

namespace segorient {
namespace {

// Whether every entry is a point of the cloud: a table of another cloud may not lead out of this
// one.
bool fits(const Neighborhoods& table, std::size_t points) {
  if (table.size() != points) return false;
  // Negative ones are too large as well.
  using Unsigned = std::make_unsigned_t<pcl::index_t>;
  const auto outside = [&](const pcl::index_t* entries, std::size_t count) {
    bool any = false;
    for (std::size_t i = 0; i < count; ++i)
      any |= static_cast<Unsigned>(entries[i]) >= static_cast<Unsigned>(points);
    return any;
  };
  bool full = true;
  for (std::size_t row = 0; row < points && full; ++row) full = table.count(row) == table.k();
  // Nearly always all rows are full, so that the entries follow one another.
  if (full) return !outside(table.indices(0), points * static_cast<std::size_t>(table.k()));
  for (std::size_t row = 0; row < points; ++row) {
    if (outside(table.indices(row), static_cast<std::size_t>(table.count(row)))) return false;
  }
  return true;
}

void copyNormal(const NormalView& normals, std::size_t i, float* to) {
  std::copy_n(normals[i], 3, to);
  to[3] = normals[i][normals.curvature];
}

// The table of the compact cloud by queries to a search on the original one. Duplicates in an
// answer are one neighbour.
void searchEach(const CloudSegmentation::Search& search, const std::vector<pcl::index_t>& source,
                const std::vector<pcl::index_t>& row_of_point, int k, Neighborhoods& table) {
  table.reset(source.size(), k, false);
  pcl::Indices found;
  std::vector<float> distances;
  for (std::size_t row = 0; row < source.size(); ++row) {
    found.clear();
    search(source[row], k, found, distances);
    pcl::index_t* entries = table.mutableIndices(row);
    entries[0] = static_cast<pcl::index_t>(row);
    int count = 1;
    for (const pcl::index_t point : found) {
      if (point < 0 || static_cast<std::size_t>(point) >= row_of_point.size() || count == k)
        continue;
      const pcl::index_t other = row_of_point[static_cast<std::size_t>(point)];
      if (other < 0 || std::find(entries, entries + count, other) != entries + count) continue;
      entries[count++] = other;
    }
    table.setCount(row, count);
  }
}

// The segments of the distinct points as segments of the whole cloud.
Segmentation expand(const Segmentation& compact, const std::vector<pcl::index_t>& row_of_point,
                    const NormalView& normals) {
  Segmentation result;
  const std::size_t n = row_of_point.size();
  result.labels.assign(n, -1);
  result.signs.assign(n, 1);
  std::vector<std::uint32_t> sizes(compact.segments.size(), 0);
  for (std::size_t p = 0; p < n; ++p) {
    if (row_of_point[p] < 0) continue;
    const std::int32_t label = compact.labels[static_cast<std::size_t>(row_of_point[p])];
    if (label < 0) continue;
    result.labels[p] = label;
    ++sizes[static_cast<std::size_t>(label)];
  }
  std::size_t count = 0;
  const std::vector<std::int32_t> rank = segmentation::rankLabels(result.labels, sizes, count);
  result.segments.resize(count);
  for (std::size_t s = 0; s < rank.size(); ++s) {
    Segment& segment = result.segments[static_cast<std::size_t>(rank[s])];
    segment = compact.segments[s];
    segment.size = sizes[s];
  }
  for (std::size_t p = 0; p < n; ++p) {
    if (result.labels[p] < 0) continue;
    result.labels[p] = rank[static_cast<std::size_t>(result.labels[p])];
    const auto row = static_cast<std::size_t>(row_of_point[p]);
    result.signs[p] = compact.signs[row];
    // A duplicate may come with the opposite normal.
    const auto& reference =
        result.segments[static_cast<std::size_t>(result.labels[p])].reference_normal;
    const float* n_p = normals[p];
    const float along = n_p[0] * reference[0] + n_p[1] * reference[1] + n_p[2] * reference[2];
    if (along * static_cast<float>(result.signs[p]) < 0.F) {
      result.signs[p] = static_cast<std::int8_t>(-result.signs[p]);
    }
  }
  segmentation::fillMembers(result);
  return result;
}

}  // namespace

void CloudSegmentation::clear() {
  result_ = Segmentation{};
  faces_ = Segmentation{};
  united_ = false;
  report_ = SegmentationReport{};
  table_ = nullptr;
  own_table_ = Neighborhoods{};
  source_.clear();
  row_of_point_.clear();
}

bool CloudSegmentation::compute(const Input& input, const SegmentationOptions& options) {
  clear();
  if (input.normals.size != input.points.size || input.points.size == 0) return false;
  neighbors_ = std::max(input.neighbors, 1);
  united_ = input.unite_smooth;
  if (input.table != nullptr) return computeWithTable(input, options);
  computeCompact(input, options);
  return true;
}

bool CloudSegmentation::computeWithTable(const Input& input, const SegmentationOptions& options) {
  if (!fits(*input.table, input.points.size)) return false;
  NormalView normals = input.normals;
  std::vector<float> masked;
  if (input.indices != nullptr) {
    std::vector<char> wanted(input.points.size, 0);
    for (const pcl::index_t i : *input.indices) {
      if (i >= 0 && static_cast<std::size_t>(i) < wanted.size())
        wanted[static_cast<std::size_t>(i)] = 1;
    }
    masked.resize(4 * wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      copyNormal(input.normals, i, &masked[4 * i]);
      if (wanted[i] == 0) masked[4 * i] = std::numeric_limits<float>::quiet_NaN();
    }
    normals = {masked.data(), 4, wanted.size()};
  }
  SegmentationOptions used = options;
  used.neighbors = neighbors_;
  table_ = input.table;
  result_ =
      segmentByNormals(input.points, normals, *table_, used, &report_, united_ ? &faces_ : nullptr);
  return true;
}

void CloudSegmentation::computeCompact(const Input& input, const SegmentationOptions& options) {
  const CompactCloud compact = compactCloud(input.points, input.indices, options.threads);
  const auto pointAt = [&](std::size_t position) {
    return input.indices != nullptr ? (*input.indices)[position]
                                    : static_cast<pcl::index_t>(position);
  };
  row_of_point_.assign(input.points.size, -1);
  for (std::size_t i = 0; i < compact.row_of.size(); ++i) {
    if (compact.row_of[i] >= 0)
      row_of_point_[static_cast<std::size_t>(pointAt(i))] = compact.row_of[i];
  }
  source_.reserve(compact.size());
  std::vector<float> normals(4 * compact.size());
  for (std::size_t row = 0; row < compact.size(); ++row) {
    source_.push_back(pointAt(static_cast<std::size_t>(compact.source[row])));
    copyNormal(input.normals, static_cast<std::size_t>(source_.back()), &normals[4 * row]);
  }
  const int k = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(neighbors_) + 1,
                                                       std::max<std::size_t>(compact.size(), 1)));
  if (input.search) {
    searchEach(input.search, source_, row_of_point_, k, own_table_);
  } else {
    search::MedianHashIndex index;
    search::MedianHashIndex::Options search_options;
    search_options.threads = options.threads;
    index.build(compact.view(), nullptr, search_options);
    index.nearestKAll(k, own_table_);
  }
  SegmentationOptions used = options;
  used.neighbors = neighbors_;
  Segmentation faces;
  const Segmentation segments =
      segmentByNormals(compact.view(), {normals.data(), 4, compact.size()}, own_table_, used,
                       &report_, united_ ? &faces : nullptr);
  result_ = expand(segments, row_of_point_, input.normals);
  if (united_) faces_ = expand(faces, row_of_point_, input.normals);
}

std::vector<float> CloudSegmentation::confidences() const {
  const std::vector<std::int32_t>& labels = faces().labels;
  const Neighborhoods& table = table_ != nullptr ? *table_ : own_table_;
  std::vector<float> result(labels.size(), 0.F);
  const auto pointOf = [&](pcl::index_t row) {
    return static_cast<std::size_t>(table_ != nullptr ? row
                                                      : source_[static_cast<std::size_t>(row)]);
  };
  for (std::size_t row = 0; row < table.size(); ++row) {
    const std::size_t p = pointOf(static_cast<pcl::index_t>(row));
    const int count = std::min(table.count(row), neighbors_ + 1);
    if (labels[p] < 0 || count < 2) continue;
    int same = 0;
    for (int j = 1; j < count; ++j) same += labels[pointOf(table.indices(row)[j])] == labels[p];
    result[p] = static_cast<float>(same) / static_cast<float>(count - 1);
  }
  // Exact duplicates have the row of the first of them.
  for (std::size_t p = 0; p < row_of_point_.size(); ++p) {
    if (row_of_point_[p] >= 0) result[p] = result[pointOf(row_of_point_[p])];
  }
  return result;
}

SegmentGraph CloudSegmentation::graph() const {
  if (table_ != nullptr) return buildSegmentGraph(result_, *table_, neighbors_);
  Segmentation rows;
  rows.segments.resize(result_.segments.size());
  rows.labels.reserve(source_.size());
  for (const pcl::index_t p : source_)
    rows.labels.push_back(result_.labels[static_cast<std::size_t>(p)]);
  SegmentGraph graph = buildSegmentGraph(rows, own_table_, neighbors_);
  for (BorderPair& pair : graph.pairs) {
    pair.in_a = source_[static_cast<std::size_t>(pair.in_a)];
    pair.in_b = source_[static_cast<std::size_t>(pair.in_b)];
  }
  return graph;
}

}  // namespace segorient
