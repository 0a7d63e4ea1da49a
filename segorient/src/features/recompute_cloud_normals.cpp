// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/features/impl/cloud_recomputation.hpp>

#include <algorithm>

#include "common/refers_to.h"
#include "features/recompute_normals.h"
#include "search/prepared_cloud.h"

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

// The same for some points of a cloud only: the others have no label meanwhile.
RecomputationReport repeatAmong(const PointView& points, const std::vector<pcl::index_t>& indices,
                                const Neighborhoods& neighborhoods,
                                const std::vector<std::uint8_t>& regular,
                                const RecomputationOptions& options, int rounds,
                                std::vector<std::int32_t>& labels, std::vector<float>& normals) {
  std::vector<std::uint8_t> used(points.size, 0);
  for (const pcl::index_t index : indices) {
    const auto i = static_cast<std::size_t>(index);
    if (index >= 0 && i < points.size) used[i] = 1;
  }
  std::vector<std::int32_t> of_used = labels;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (used[i] == 0) of_used[i] = -1;
  }
  const RecomputationReport report =
      repeat(points, neighborhoods, regular, options, rounds, of_used, normals);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (used[i] != 0) labels[i] = of_used[i];
  }
  return report;
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
    if (neighborhoods->size() != points.size || !refersTo(*neighborhoods, points.size)) return {};
    return repeatAmong(points, indices, *neighborhoods, regular, options, rounds, labels, normals);
  }
  PreparedCloud cloud(points, &indices, options.threads);
  cloud.findNeighbors(std::max(options.k, 1), false);
  std::vector<std::int32_t> point_labels(cloud.size());
  std::vector<float> point_normals(4 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    point_labels[i] = labels[cloud.rowOf(i)];
    std::copy_n(&normals[4 * cloud.rowOf(i)], 4, &point_normals[4 * i]);
  }
  const std::vector<std::int32_t> old_labels = point_labels;
  const std::vector<float> old_normals = point_normals;
  const RecomputationReport report = repeat(cloud.points(), cloud.neighborhoods(), regular, options,
                                            rounds, point_labels, point_normals);
  for (std::size_t row = 0; row < cloud.rows(); ++row) {
    if (cloud.pointOf(row) < 0) continue;
    const auto i = static_cast<std::size_t>(cloud.pointOf(row));
    if (point_labels[i] != old_labels[i]) labels[row] = point_labels[i];
    if (!std::equal(&point_normals[4 * i], &point_normals[4 * i] + 3, &old_normals[4 * i])) {
      std::copy_n(&point_normals[4 * i], 3, &normals[4 * row]);
    }
  }
  return report;
}

}  // namespace segorient
