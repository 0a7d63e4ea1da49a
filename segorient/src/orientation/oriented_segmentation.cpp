// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/compact_cloud.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/unit_vector.h>
#include <segorient/features/sheet_normals.h>
#include <segorient/orientation/oriented_segmentation.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "segment_members.h"

namespace segorient {
namespace {

int defaultNeighbors(const OrientationOptions& options) {
  return options.method == OrientationMethod::AUTO ? kSheetNeighbors : 12;
}

Neighborhoods findNeighbors(const CompactCloud& cloud, int wanted, const PointSearch& search,
                            int threads) {
  // More neighbours cost time and memory and say nothing more about who borders whom.
  constexpr std::size_t kMostNeighbors = 128;
  const std::size_t most = std::max<std::size_t>(1, cloud.size()) - 1;
  const std::size_t neighbors = std::min({kMostNeighbors, most, static_cast<std::size_t>(wanted)});
  const int k = static_cast<int>(neighbors) + 1;
  Neighborhoods out;
  if (search) {
    searchNeighborhoods(cloud, search, k, out);
    return out;
  }
  search::MedianHashIndex index;
  search::MedianHashIndex::Options search_options;
  search_options.threads = threads;
  index.build(cloud.view(), nullptr, search_options);
  index.nearestKAll(k, out);
  return out;
}

bool labelsInRange(const Segmentation& segmentation, std::size_t rows) {
  if (segmentation.labels.size() != rows || segmentation.signs.size() != rows) return false;
  const auto segments = static_cast<std::int64_t>(segmentation.segments.size());
  return std::all_of(segmentation.labels.begin(), segmentation.labels.end(),
                     [&](std::int32_t label) { return label < segments; });
}

std::vector<float> compactNormals(const CompactCloud& cloud, const NormalView& normals) {
  std::vector<float> out(4 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* normal = normals[static_cast<std::size_t>(cloud.source[i])];
    unitVector(normal, &out[4 * i]);
    out[4 * i + 3] = normal[normals.curvature];
  }
  return out;
}

Segmentation compactSegmentation(const CompactCloud& cloud, const std::vector<float>& normals,
                                 const Segmentation& segmentation) {
  Segmentation out;
  out.segments = segmentation.segments;
  out.labels.resize(cloud.size());
  out.signs.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto row = static_cast<std::size_t>(cloud.source[i]);
    out.labels[i] = std::isfinite(normals[4 * i]) ? std::max(segmentation.labels[row], -1) : -1;
    out.signs[i] = segmentation.signs[row] < 0 ? std::int8_t{-1} : std::int8_t{1};
  }
  collectMembers(out);
  return out;
}

// Results of the distinct points for all rows: a repeated point's normal may have either sign, so
// its sign is the one that turns it like the first.
OrientationResult scatter(const CompactCloud& cloud, const PointView& normals,
                          const OrientationResult& compact) {
  OrientationResult out;
  out.segments = compact.segments;
  out.components = compact.components;
  const std::size_t rows = cloud.row_of.size();
  out.point_signs.assign(rows, 0);
  out.point_confidences.assign(rows, 0.F);
  out.point_components.assign(rows, -1);
  for (std::size_t row = 0; row < rows; ++row) {
    if (cloud.row_of[row] < 0 || !isFinite(normals[row])) continue;
    const auto i = static_cast<std::size_t>(cloud.row_of[row]);
    const float* first = normals[static_cast<std::size_t>(cloud.source[i])];
    const float* own = normals[row];
    const bool turned = first[0] * own[0] + first[1] * own[1] + first[2] * own[2] < 0.F;
    out.point_signs[row] =
        static_cast<std::int8_t>(turned ? -compact.point_signs[i] : compact.point_signs[i]);
    out.point_confidences[row] = compact.point_confidences[i];
    out.point_components[row] = compact.point_components[i];
  }
  return out;
}

Segmentation scatter(const CompactCloud& cloud, const PointView& normals,
                     const Segmentation& compact) {
  Segmentation out;
  out.segments = compact.segments;
  const std::size_t rows = cloud.row_of.size();
  out.labels.assign(rows, -1);
  out.signs.assign(rows, 0);
  for (std::size_t row = 0; row < rows; ++row) {
    if (cloud.row_of[row] < 0) continue;
    const auto i = static_cast<std::size_t>(cloud.row_of[row]);
    const float* first = normals[static_cast<std::size_t>(cloud.source[i])];
    const float* own = normals[row];
    const bool turned = first[0] * own[0] + first[1] * own[1] + first[2] * own[2] < 0.F;
    out.labels[row] = compact.labels[i];
    out.signs[row] = static_cast<std::int8_t>(turned ? -compact.signs[i] : compact.signs[i]);
  }
  collectMembers(out);
  return out;
}

// Inverts everything in segments that were turned over: their reference normals and, with these,
// what their points' signs refer to. Triangulations made from them then have their fronts outward.
void invertTurned(const std::vector<SegmentOrientationResult>& results,
                  Segmentation& segmentation) {
  for (std::size_t s = 0; s < results.size(); ++s) {
    if (results[s].sign >= 0) continue;
    for (float& c : segmentation.segments[s].reference_normal) c = -c;
  }
  for (std::size_t i = 0; i < segmentation.labels.size(); ++i) {
    const std::int32_t label = segmentation.labels[i];
    if (label < 0 || results[static_cast<std::size_t>(label)].sign >= 0) continue;
    segmentation.signs[i] = static_cast<std::int8_t>(-segmentation.signs[i]);
  }
}

}  // namespace

OrientedSegmentation orientSegmentation(const PointView& points, const NormalView& normals,
                                        const Segmentation* segmentation, int k,
                                        const SegmentationOptions& segmentation_options,
                                        const OrientationOptions& options,
                                        const PointSearch& search) {
  OrientedSegmentation out;
  if (normals.size != points.size) return out;
  if (segmentation != nullptr && !labelsInRange(*segmentation, points.size)) return out;

  const CompactCloud cloud = compactCloud(points, nullptr, options.threads);
  const std::vector<float> distinct_normals = compactNormals(cloud, normals);
  const NormalView normal_view{distinct_normals.data(), 4, cloud.size()};
  const Neighborhoods neighborhoods =
      findNeighbors(cloud, k > 0 ? k : defaultNeighbors(options), search, options.threads);

  const Segmentation distinct =
      segmentation != nullptr
          ? compactSegmentation(cloud, distinct_normals, *segmentation)
          : segmentByNormals(cloud.view(), normal_view, neighborhoods, segmentation_options);
  SegmentGraph graph;  // the default method does without
  if (options.method != OrientationMethod::AUTO) graph = buildSegmentGraph(distinct, neighborhoods);
  PointHints hints;
  if (options.hints) hints = resolveHints(*options.hints, cloud, nullptr, options.threads);
  out.orientation = scatter(
      cloud, normals,
      orientSegments(cloud.view(), normal_view, neighborhoods, distinct, graph, options, hints));
  out.segmentation = segmentation != nullptr ? *segmentation : scatter(cloud, normals, distinct);
  invertTurned(out.orientation.segments, out.segmentation);
  return out;
}

}  // namespace segorient
