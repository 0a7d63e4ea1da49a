// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/region_growing.h"

#include <utility>

#include "segmentation/clean_up.h"
#include "segmentation/growth_state.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {

Segmentation segmentByNormals(const PointView& points, const NormalView& normals,
                              const Neighborhoods& neighborhoods,
                              const SegmentationOptions& options, SegmentationReport* report,
                              Segmentation* faces) {
  SegmentationReport counts;
  Segmentation result;
  if (faces != nullptr) *faces = Segmentation{};
  if (points.size > 0 && points.size == normals.size && points.size == neighborhoods.size()) {
    segmentation::GrowthState state;
    state.neighborhoods = &neighborhoods;
    state.neighbors = neighborhoods.k();
    if (options.neighbors > 0)
      state.neighbors = std::min(state.neighbors - 1, options.neighbors) + 1;
    segmentation::prepare(points, normals, options, state);
    counts.offset_limit = state.limits.offset;
    segmentation::grow(options, state);
    counts.grown = state.clusters.size();
    for (const auto& cluster : state.clusters) counts.small += cluster.size < options.small_size;
    segmentation::cleanUp(options, state, &counts);
    result = faces == nullptr ? segmentation::finish(points, state, std::move(state.labels),
                                                     std::move(state.signs))
                              : segmentation::finish(points, state, state.labels, state.signs);
    segmentation::collectMembers(result);
    for (const Segment& segment : result.segments) {
      counts.regular += segment.kind == SegmentKind::REGULAR;
      counts.connected += segment.kind == SegmentKind::CONNECTED;
      counts.isolated += segment.kind == SegmentKind::ISOLATED;
    }
    if (faces != nullptr) {
      counts.united = segmentation::uniteSmooth(options, state);
      *faces = counts.united > 0 ? segmentation::finish(points, state, std::move(state.labels),
                                                        std::move(state.signs))
                                 : result;
      if (counts.united > 0) segmentation::collectMembers(*faces);
    }
  }
  if (report != nullptr) *report = counts;
  return result;
}

}  // namespace segorient
