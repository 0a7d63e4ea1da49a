// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/completion.h>
#include <segorient/orientation/component_sign.h>
#include <segorient/orientation/consistency.h>
#include <segorient/orientation/extremal.h>
#include <segorient/orientation/folded_segments.h>
#include <segorient/orientation/orient_segments.h>
#include <segorient/orientation/point_tree.h>
#include <segorient/orientation/segment_links.h>
#include <segorient/orientation/segment_methods.h>
#include <segorient/orientation/triangulated_boundary.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "auto_stages.h"

namespace segorient {
namespace {

std::vector<pcl::index_t> usableRows(const PointView& points, const PointView& normals) {
  std::vector<pcl::index_t> rows;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (isFinite(points[i]) && isFinite(normals[i])) rows.push_back(static_cast<pcl::index_t>(i));
  }
  return rows;
}

std::vector<SegmentOrientationResult> runMethod(const SegmentEvidence& evidence,
                                                const OrientationOptions& options) {
  SegmentMethodOptions method_options;
  method_options.gamma = options.gamma;
  method_options.min_margin = options.min_margin;
  switch (options.method) {
    case OrientationMethod::PROPAGATION:
      return propagateOrientation(evidence, method_options);
    case OrientationMethod::BOUNDARY:
      return orientByBoundaries(evidence, method_options);
    case OrientationMethod::EXTREMAL:
      return orientByExtremalPoints(evidence, method_options);
    case OrientationMethod::AUTO:  // has its own way, see orientAutomatically()
    case OrientationMethod::COMBINED:
      break;
  }
  return orientCombined(evidence, method_options);
}

std::vector<BoundaryVote> boundaryVotes(const PointView& points, const PointView& normals,
                                        const Neighborhoods& neighborhoods,
                                        const Segmentation& segmentation, const SegmentLinks& links,
                                        const OrientationOptions& options) {
  if (options.boundary == BoundaryTest::LOCAL) {
    return localBoundaryVotes(points, normals, neighborhoods, segmentation, links, options.threads);
  }
  TriangulationOptions triangulation = options.triangulation;
  triangulation.threads = options.threads;
  return triangulatedBoundaryVotes(points, segmentation, links,
                                   triangulateSegments(points, segmentation, triangulation));
}

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

// Segments that run over two sides are not oriented in themselves: they no longer count as regular,
// and their points are oriented one by one. Enough rounds for segments that only show then.
constexpr int kMostRounds = 4;

// Oriented regular segments, those of mixed sides left out and marked as hard.
struct OrientedSegments {
  std::vector<SegmentOrientationResult> results;
  std::vector<std::int32_t> mixed;
  std::vector<BorderBalance> components;
};

OrientedSegments orientRegularSegments(const PointView& points, const PointView& normals,
                                       const Neighborhoods& neighborhoods,
                                       const Segmentation& given, const SegmentGraph& graph,
                                       const OrientationOptions& options) {
  const std::vector<ExtremalPoint> extremal_points =
      findExtremalPoints(points, normals, usableRows(points, normals), options.max_box_points);
  OrientedSegments out;
  // Propagation knows no borders to check by.
  const bool check = options.check_borders && options.method != OrientationMethod::PROPAGATION;
  Segmentation without_mixed;
  const Segmentation* segmentation = &given;
  std::vector<std::int32_t> mixed;
  if (check) mixed = findFoldedSegments(points, neighborhoods, given);
  for (int round = 1;; ++round) {
    if (!mixed.empty()) {
      if (out.mixed.empty()) without_mixed = given;
      segmentation = &without_mixed;
      for (const std::int32_t s : mixed) {
        without_mixed.segments[static_cast<std::size_t>(s)].kind = SegmentKind::Connected;
      }
      out.mixed.insert(out.mixed.end(), mixed.begin(), mixed.end());
    }
    const SegmentLinks links = linkRegularSegments(*segmentation, graph, neighborhoods);
    const std::vector<float> cosines =
        segmentCosines(points, normals, *segmentation, links, options.angle);
    const std::vector<BoundaryVote> boundary =
        boundaryVotes(points, normals, neighborhoods, *segmentation, links, options);
    const std::vector<ExtremalEvidence> extremal =
        gatherExtremalEvidence(extremal_points, *segmentation, options.gamma);
    out.results = runMethod({*segmentation, links, cosines, boundary, extremal}, options);
    out.components = balanceComponents(links, boundary, out.results);
    if (!check || round == kMostRounds) break;
    mixed = findMixedSegments(links, boundary, out.results);
    if (mixed.empty()) break;
  }
  return out;
}

// The default method brings its own segments: each given point takes the sign that turns its normal
// to the oriented one there, and each given segment that of most of its points.
OrientationResult orientAutomatically(const PointView& points, const PointView& normals,
                                      const Neighborhoods& neighborhoods,
                                      const Segmentation& segmentation,
                                      const OrientationOptions& options, const PointHints& hints) {
  PipelineOptions settings;
  settings.threads = options.threads;
  detail::AutoNormals found = detail::orientPoints(points, neighborhoods, settings, hints);
  OrientationResult result;
  result.components = std::move(found.orientation.result.components);
  result.point_signs.assign(points.size, 0);
  result.point_confidences.assign(points.size, 0.F);
  result.point_components.assign(points.size, -1);
  for (std::size_t i = 0; i < points.size; ++i) {
    const float* m = &found.normals[4 * i];
    const float* n = normals[i];
    if (!isFinite(n) || !isFinite(m) || found.components[i] < 0) continue;
    const float agree = n[0] * m[0] + n[1] * m[1] + n[2] * m[2];
    result.point_signs[i] = agree < 0.F ? std::int8_t{-1} : std::int8_t{1};
    result.point_confidences[i] = found.confidences[i];
    result.point_components[i] = found.components[i];
  }
  completeOrientation(points, normals, neighborhoods, result);
  summarizeSegments(segmentation, DecidedBy::GLOBAL, result);
  return result;
}

// Turns each component so that its largest segment keeps its sign (labels are by descending size).
void keepLargestSegments(const Segmentation& segmentation, OrientationResult& result) {
  std::vector<std::int8_t> turn(result.components.size(), 0);
  for (const SegmentOrientationResult& s : result.segments) {
    if (s.component < 0) continue;
    std::int8_t& t = turn[static_cast<std::size_t>(s.component)];
    if (t == 0) t = s.sign;
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
                                 const OrientationOptions& options, const PointHints& hints) {
  OrientationResult result;
  if (normals.size != points.size || neighborhoods.size() != points.size ||
      segmentation.labels.size() != points.size) {
    result.point_signs.assign(points.size, 0);
    result.point_confidences.assign(points.size, 0.F);
    result.point_components.assign(points.size, -1);
    return result;
  }
  if (options.method == OrientationMethod::PROPAGATION && options.point_tree) {
    result = orientByPointTree(points, normals, neighborhoods);
    summarizeSegments(segmentation, DecidedBy::PROPAGATION, result);
    return result;
  }

  if (options.method == OrientationMethod::AUTO) {
    result = orientAutomatically(points, normals, neighborhoods, segmentation, options, hints);
    if (!options.turn_outward) keepLargestSegments(segmentation, result);
    return result;
  }

  const OrientedSegments oriented =
      orientRegularSegments(points, normals, neighborhoods, segmentation, graph, options);
  result.segments = oriented.results;

  spreadToPoints(segmentation, result);
  completeOrientation(points, normals, neighborhoods, result);
  summarizeSegments(segmentation, DecidedBy::SURROUNDINGS, result);
  for (const std::int32_t s : oriented.mixed)
    result.segments[static_cast<std::size_t>(s)].hard = true;
  for (std::size_t c = 0; c < oriented.components.size(); ++c) {
    result.components[c].contradiction = oriented.components[c].contradictingShare();
  }
  if (options.turn_outward) {
    orientComponents(points, normals, neighborhoods, {options.gamma, options.max_box_points},
                     result);
  } else {
    sortComponents(result);
  }
  return result;
}

}  // namespace segorient
