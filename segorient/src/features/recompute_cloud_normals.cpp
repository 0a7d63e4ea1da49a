// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/compact_cloud.h>
#include <segorient/features/recompute_normals.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>

namespace segorient {
namespace {

RecomputationReport repeat(const PointView& points, const Neighborhoods& neighborhoods,
                           const std::vector<std::uint8_t>& regular,
                           const RecomputationOptions& options, int rounds,
                           std::vector<std::int32_t>& labels, std::vector<float>& normals) {
  RecomputationReport sum;
  for (int round = 0; round < rounds; ++round) {
    const RecomputationReport report =
        recomputeNormals(points, neighborhoods, regular, options, labels, normals);
    sum.examined += report.examined;
    sum.recomputed += report.recomputed;
    sum.moved += report.moved;
  }
  return sum;
}

bool refersTo(const Neighborhoods& neighborhoods, std::size_t size) {
  if (neighborhoods.size() != size) return false;
  for (std::size_t r = 0; r < size; ++r) {
    const pcl::index_t* row = neighborhoods.indices(r);
    const bool good = std::all_of(row, row + neighborhoods.count(r), [&](pcl::index_t q) {
      return q >= 0 && static_cast<std::size_t>(q) < size;
    });
    if (!good) return false;
  }
  return true;
}

}  // namespace

RecomputationReport recomputeCloudNormals(const PointView& points,
                                          const std::vector<pcl::index_t>& indices,
                                          const Neighborhoods* neighborhoods,
                                          const std::vector<std::uint8_t>& regular,
                                          const RecomputationOptions& options, int rounds,
                                          std::vector<std::int32_t>& labels,
                                          std::vector<float>& normals) {
  if (labels.size() != points.size || normals.size() != 4 * points.size) return {};
  if (neighborhoods) {
    if (!refersTo(*neighborhoods, points.size)) return {};
    return repeat(points, *neighborhoods, regular, options, rounds, labels, normals);
  }
  const CompactCloud cloud = compactCloud(points, &indices, options.threads);
  search::MedianHashIndex index;
  search::MedianHashIndex::Options search_options;
  search_options.threads = options.threads;
  index.build(cloud.view(), nullptr, search_options);
  Neighborhoods table;
  // More than there are would only cost memory.
  const std::size_t wanted = static_cast<std::size_t>(std::max(options.k, 1)) + 1;
  index.nearestKAll(static_cast<int>(std::min(wanted, cloud.size())), table, false);

  const auto sourceOf = [&](std::size_t row) {
    return static_cast<std::size_t>(indices[static_cast<std::size_t>(cloud.source[row])]);
  };
  std::vector<std::int32_t> compact_labels(cloud.size());
  std::vector<float> compact_normals(4 * cloud.size());
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    compact_labels[row] = labels[sourceOf(row)];
    std::copy_n(&normals[4 * sourceOf(row)], 4, &compact_normals[4 * row]);
  }
  const std::vector<std::int32_t> old_labels = compact_labels;
  const std::vector<float> old_normals = compact_normals;
  const RecomputationReport report =
      repeat(cloud.view(), table, regular, options, rounds, compact_labels, compact_normals);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (cloud.row_of[i] < 0) continue;
    const auto row = static_cast<std::size_t>(cloud.row_of[i]);
    const auto point = static_cast<std::size_t>(indices[i]);
    if (compact_labels[row] != old_labels[row]) labels[point] = compact_labels[row];
    if (!std::equal(&compact_normals[4 * row], &compact_normals[4 * row] + 3,
                    &old_normals[4 * row])) {
      std::copy_n(&compact_normals[4 * row], 3, &normals[4 * point]);
    }
  }
  return report;
}

}  // namespace segorient
