// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/orient_segments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "orientation/paper/completion.h"
#include "orientation/paper/hoppe_tree.h"
#include "orientation/paper/outward_components.h"
#include "orientation/paper/regular_segments.h"

namespace segorient {
namespace {

// Signs of the points of regular segments; the others stay open.
void spreadToPoints(const Segmentation& segmentation, OrientationResult& result) {
  const std::size_t n = segmentation.labels.size();
  result.point_signs.assign(n, 0);
  result.point_confidences.assign(n, 0.F);
  result.point_components.assign(n, -1);
  std::int32_t components = 0;
  for (const SegmentOrientationResult& segment : result.segments) {
    components = std::max(components, segment.component + 1);
  }
  result.components.resize(static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < n; ++i) {
    if (segmentation.labels[i] < 0) continue;
    const SegmentOrientationResult& segment =
        result.segments[static_cast<std::size_t>(segmentation.labels[i])];
    if (segment.sign == 0) continue;
    result.point_signs[i] = static_cast<std::int8_t>(segment.sign * segmentation.signs[i]);
    result.point_confidences[i] = segment.confidence;
    result.point_components[i] = segment.component;
  }
}

}  // namespace

void summarizeSegments(const Segmentation& segmentation, DecidedBy by, OrientationResult& result) {
  result.segments.resize(segmentation.segments.size());
  for (std::size_t s = 0; s < result.segments.size(); ++s) {
    SegmentOrientationResult& segment = result.segments[s];
    if (segment.sign != 0 || segmentation.segments[s].size == 0) continue;
    int balance = 0;
    for (const pcl::index_t* p = segmentation.begin(s); p != segmentation.end(s); ++p) {
      const auto i = static_cast<std::size_t>(*p);
      balance += result.point_signs[i] * segmentation.signs[i];
    }
    segment.sign = balance < 0 ? std::int8_t{-1} : std::int8_t{1};
    segment.by = by;
    segment.confidence =
        static_cast<float>(std::abs(balance)) / static_cast<float>(segmentation.segments[s].size);
    segment.component = result.point_components[static_cast<std::size_t>(*segmentation.begin(s))];
  }
}

OrientationResult orientSegments(const PointView& points, const PointView& normals,
                                 const Neighborhoods& neighborhoods,
                                 const Segmentation& segmentation,
                                 const OrientationOptions& options) {
  OrientationResult result;
  if (options.method == OrientationMethod::HOPPE) {
    result = orientByPointTree(points, normals, neighborhoods);
    summarizeSegments(segmentation, DecidedBy::PROPAGATION, result);
    return result;
  }

  OrientedRegularSegments oriented =
      orientRegularSegments(points, normals, neighborhoods, segmentation, options);
  result.segments = std::move(oriented.results);

  spreadToPoints(segmentation, result);
  completeOrientation(points, normals, neighborhoods, result);
  summarizeSegments(segmentation, DecidedBy::SURROUNDINGS, result);
  for (const std::int32_t s : oriented.mixed)
    result.segments[static_cast<std::size_t>(s)].hard = true;
  for (std::size_t c = 0; c < oriented.components.size(); ++c) {
    result.components[c].contradiction = oriented.components[c].contradictingShare();
  }
  if (options.turn_outward) {
    orientComponents(points, normals, neighborhoods, options, result, oriented.extremal);
  } else {
    sortComponents(result);
  }
  return result;
}

}  // namespace segorient
