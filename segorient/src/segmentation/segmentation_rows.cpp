// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/segmentation_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/at.h"
#include "common/dot.h"

namespace segorient::segmentation {
namespace {

void restoreUnit(float unit, Segment& segment) {
  for (float& v : segment.centroid) v *= unit;
  segment.area *= unit * unit;
  segment.rms *= unit;
}

}  // namespace

void collectMembers(Segmentation& segmentation) {
  std::vector<Segment>& segments = segmentation.segments;
  for (Segment& segment : segments) segment.size = 0;
  for (const std::int32_t label : segmentation.labels) {
    if (label >= 0) ++segments[at(label)].size;
  }
  std::uint32_t first = 0;
  for (Segment& segment : segments) {
    segment.first = first;
    first += segment.size;
  }
  segmentation.members.resize(first);
  std::vector<std::uint32_t> next;
  next.reserve(segments.size());
  for (const Segment& segment : segments) next.push_back(segment.first);
  for (std::size_t i = 0; i < segmentation.labels.size(); ++i) {
    const std::int32_t label = segmentation.labels[i];
    if (label < 0) continue;
    segmentation.members[next[at(label)]++] = static_cast<pcl::index_t>(i);
  }
}

SegmentationOptions inUnitOf(const PreparedCloud& cloud, const SegmentationOptions& options) {
  SegmentationOptions out = options;
  if (out.max_residual < std::numeric_limits<float>::max()) out.max_residual /= cloud.unit();
  return out;
}

std::vector<float> gatherNormals(const PreparedCloud& cloud, const NormalView& row_normals) {
  std::vector<float> out(4 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* normal = row_normals[cloud.rowOf(i)];
    std::copy_n(normal, 3, &out[4 * i]);
    out[4 * i + 3] = normal[row_normals.curvature];
  }
  return out;
}

Segmentation gather(const PreparedCloud& cloud, const std::vector<float>& normals,
                    const Segmentation& of_rows) {
  Segmentation out;
  out.segments = of_rows.segments;
  out.labels.resize(cloud.size());
  out.signs.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::size_t row = cloud.rowOf(i);
    out.labels[i] = std::isfinite(normals[4 * i]) ? std::max(of_rows.labels[row], -1) : -1;
    out.signs[i] = of_rows.signs[row] < 0 ? std::int8_t{-1} : std::int8_t{1};
  }
  collectMembers(out);
  return out;
}

bool isTurned(const PreparedCloud& cloud, const PointView& row_normals, std::size_t row) {
  const pcl::index_t point = cloud.pointOf(row);
  if (point < 0) return false;
  return dot(row_normals[cloud.rowOf(at(point))], row_normals[row]) < 0.F;
}

Segmentation scatter(const PreparedCloud& cloud, const Segmentation& of_points,
                     const PointView* row_normals) {
  Segmentation out;
  out.labels = cloud.scatter(of_points.labels, 1, std::int32_t{-1});
  out.signs = cloud.scatter(of_points.signs, 1, std::int8_t{0});
  if (row_normals != nullptr) {
    for (std::size_t row = 0; row < cloud.rows(); ++row) {
      if (isTurned(cloud, *row_normals, row))
        out.signs[row] = static_cast<std::int8_t>(-out.signs[row]);
    }
  }
  out.segments = of_points.segments;
  collectMembers(out);
  for (Segment& segment : out.segments) restoreUnit(cloud.unit(), segment);
  return out;
}

}  // namespace segorient::segmentation
