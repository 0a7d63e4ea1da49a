// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/follow_normals.h"

#include <cstdint>
#include <vector>

#include "common/dot.h"
#include "orientation/automatic/stages.h"
#include "orientation/orient_segments.h"
#include "orientation/paper/completion.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {
namespace {

// Each given point takes the sign that turns its normal to the oriented one there.
void takeSigns(const PointView& normals, const detail::AutoStages& found,
               OrientationResult& result) {
  result.point_signs.assign(normals.size, 0);
  result.point_confidences.assign(normals.size, 0.F);
  result.point_components.assign(normals.size, -1);
  for (std::size_t i = 0; i < normals.size; ++i) {
    const float* m = &found.normals[4 * i];
    const float* n = normals[i];
    if (!isFinite(n) || !isFinite(m) || found.components[i] < 0) continue;
    result.point_signs[i] = dot(n, m) < 0.F ? std::int8_t{-1} : std::int8_t{1};
    result.point_confidences[i] = found.confidences[i];
    result.point_components[i] = found.components[i];
  }
}

// Turns each component so that its largest segment keeps its sign.
void keepLargestSegments(const Segmentation& segmentation, OrientationResult& result) {
  std::vector<std::int8_t> turn(result.components.size(), 0);
  std::vector<std::uint32_t> largest(result.components.size(), 0);
  for (std::size_t i = 0; i < result.segments.size(); ++i) {
    const SegmentOrientationResult& s = result.segments[i];
    if (s.component < 0) continue;
    const auto c = static_cast<std::size_t>(s.component);
    if (segmentation.segments[i].size <= largest[c]) continue;
    largest[c] = segmentation.segments[i].size;
    turn[c] = s.sign;
  }
  for (SegmentOrientationResult& s : result.segments) {
    if (s.component < 0 || turn[static_cast<std::size_t>(s.component)] >= 0) continue;
    s.sign = static_cast<std::int8_t>(-s.sign);
  }
  for (std::size_t i = 0; i < segmentation.labels.size(); ++i) {
    const std::int32_t c = result.point_components[i];
    if (c < 0 || turn[static_cast<std::size_t>(c)] >= 0) continue;
    result.point_signs[i] = static_cast<std::int8_t>(-result.point_signs[i]);
  }
}

}  // namespace

void giveSigns(const PointView& normals, Segmentation& segmentation) {
  for (std::size_t i = 0; i < normals.size; ++i) {
    std::int32_t& label = segmentation.labels[i];
    if (!isFinite(normals[i])) label = -1;
    if (label < 0) continue;
    const float* reference =
        segmentation.segments[static_cast<std::size_t>(label)].reference_normal.data();
    segmentation.signs[i] = dot(normals[i], reference) < 0.F ? std::int8_t{-1} : std::int8_t{1};
  }
  segmentation::collectMembers(segmentation);
}

OrientationResult followNormals(const PointView& points, const PointView& normals,
                                const Neighborhoods& neighborhoods,
                                const Segmentation& segmentation, bool turn_outward,
                                const detail::AutoStages& found) {
  OrientationResult result;
  result.components = found.orientation.result.components;
  takeSigns(normals, found, result);
  completeOrientation(points, normals, neighborhoods, result);
  summarizeSegments(segmentation, DecidedBy::GLOBAL, result);
  if (!turn_outward) keepLargestSegments(segmentation, result);
  return result;
}

}  // namespace segorient
