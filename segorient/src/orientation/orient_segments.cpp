// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/orient_segments.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/dot.h"
#include "orientation/automatic/stages.h"
#include "orientation/paper/completion.h"
#include "orientation/paper/hoppe_tree.h"
#include "orientation/paper/outward_components.h"
#include "orientation/paper/regular_segments.h"
#include "segmentation/segmentation_rows.h"

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

// Connected and isolated segments, or all where points were oriented one by one: what the majority
// of a segment's points says.
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

// Signs for normals that the segments were not made from; points without one are in no segment.
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

/// What the default method found out about the points.
struct FoundNormals {
  const std::vector<float>& normals;  // 4 floats a point
  const std::vector<float>& confidences;
  const std::vector<std::int32_t>& components;
};

// Each given point takes the sign that turns its normal to the oriented one there.
void followNormals(const PointView& normals, const FoundNormals& found, OrientationResult& result) {
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

// The default method brings its own segments; each given one takes the sign of most of its points.
OrientationResult orientAutomatically(const PointView& points, const PointView& normals,
                                      const Neighborhoods& neighborhoods,
                                      const Segmentation& segmentation,
                                      const OrientationOptions& options, const PointHints& hints,
                                      detail::AutoStages* own) {
  OrientationResult result;
  if (own != nullptr) {
    result.components = own->orientation.result.components;
    followNormals(normals, {own->normals, own->confidences, own->components}, result);
    giveSigns(normals, own->segmentation);
  } else {
    detail::AutoNormals found =
        detail::orientPoints(points, neighborhoods, options.automatic, hints, options.threads);
    result.components = std::move(found.orientation.result.components);
    followNormals(normals, {found.normals, found.confidences, found.components}, result);
  }
  completeOrientation(points, normals, neighborhoods, result);
  summarizeSegments(own != nullptr ? own->segmentation : segmentation, DecidedBy::GLOBAL, result);
  return result;
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

OrientationResult orientSegments(const PointView& points, const PointView& normals,
                                 const Neighborhoods& neighborhoods,
                                 const Segmentation& segmentation, const SegmentGraph& graph,
                                 const OrientationOptions& options, const PointHints& hints,
                                 detail::AutoStages* own) {
  OrientationResult result;
  const bool automatic = options.method == OrientationMethod::AUTO;
  if (normals.size != points.size || neighborhoods.size() != points.size ||
      (!(automatic && own != nullptr) && segmentation.labels.size() != points.size)) {
    result.point_signs.assign(points.size, 0);
    result.point_confidences.assign(points.size, 0.F);
    result.point_components.assign(points.size, -1);
    return result;
  }
  if (options.method == OrientationMethod::HOPPE) {
    result = orientByPointTree(points, normals, neighborhoods);
    summarizeSegments(segmentation, DecidedBy::PROPAGATION, result);
    return result;
  }
  if (automatic) {
    result = orientAutomatically(points, normals, neighborhoods, segmentation, options, hints, own);
    if (!options.turn_outward) {
      keepLargestSegments(own != nullptr ? own->segmentation : segmentation, result);
    }
    return result;
  }

  OrientedRegularSegments oriented =
      orientRegularSegments(points, normals, neighborhoods, segmentation, graph, options);
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
    orientComponents(points, normals, neighborhoods,
                     {options.gamma, options.max_box_points, options.threads}, result,
                     oriented.extremal);
  } else {
    sortComponents(result);
  }
  return result;
}

}  // namespace segorient
