// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/segmentation/impl/cloud_segmentation.hpp>
#include <segorient/surface/impl/cloud_triangulation.hpp>

#include <algorithm>

namespace segorient {
namespace {

// Everything that indexes stays within the cloud and the segmentation.
bool fits(const Segmentation& s, std::size_t points) {
  if (s.labels.size() != points) return false;
  for (const Segment& segment : s.segments) {
    if (segment.first > s.members.size() || segment.size > s.members.size() - segment.first)
      return false;
  }
  return std::all_of(s.members.begin(), s.members.end(), [&](pcl::index_t i) {
    return i >= 0 && static_cast<std::size_t>(i) < points;
  });
}

// The segmentation with only the wanted points as members.
Segmentation restrictTo(const Segmentation& s, const pcl::Indices& indices, std::size_t points) {
  std::vector<char> wanted(points, 0);
  for (const pcl::index_t i : indices) {
    if (i >= 0 && static_cast<std::size_t>(i) < points) wanted[static_cast<std::size_t>(i)] = 1;
  }
  Segmentation result;
  result.segments = s.segments;
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    Segment& segment = result.segments[i];
    segment.first = static_cast<std::uint32_t>(result.members.size());
    std::copy_if(s.begin(i), s.end(i), std::back_inserter(result.members),
                 [&](pcl::index_t p) { return wanted[static_cast<std::size_t>(p)] != 0; });
    segment.size = static_cast<std::uint32_t>(result.members.size()) - segment.first;
  }
  return result;
}

}  // namespace

bool triangulateCloud(const PointView& points, const NormalView& normals,
                      const Segmentation& segmentation, const pcl::Indices* indices,
                      const TriangulationOptions& options, bool all,
                      std::vector<SegmentMesh>& meshes) {
  meshes.clear();
  if (segmentation.labels.empty()) {
    CloudSegmentation::Input input;
    input.points = points;
    input.normals = normals;
    input.indices = indices;
    SegmentationOptions segmentation_options;
    segmentation_options.threads = options.threads;
    CloudSegmentation own;
    if (!own.compute(input, segmentation_options)) return false;
    meshes = triangulateSegments(points, own.segmentation(), options, all);
    return true;
  }
  if (!fits(segmentation, points.size)) return false;
  meshes = indices == nullptr
               ? triangulateSegments(points, segmentation, options, all)
               : triangulateSegments(points, restrictTo(segmentation, *indices, points.size),
                                     options, all);
  return true;
}

}  // namespace segorient
