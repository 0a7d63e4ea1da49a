// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/sheet_segmentation.h"

#include <algorithm>
#include <utility>

#include "segmentation/clean_up.h"
#include "segmentation/growth_state.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {
namespace {

// Neighbours of a point in a segment that it joins: one alone may be on another sheet.
constexpr int kSupport = 3;

// 15 degrees where residuals are those of curvature, 20 where they are noise.
float automaticAlpha(float residual) {
  constexpr float kDegree = 0.01745329F;
  const float t = std::clamp((residual - 0.05F) / 0.2F, 0.F, 1.F);
  return (15.F + 5.F * t) * kDegree;
}

}  // namespace

Segmentation segmentSheets(const PointView& points, const Neighborhoods& neighborhoods,
                           const SheetField& field, const SheetSegmentationOptions& options,
                           FinishedSegments* finished) {
  SegmentationOptions growth = options;
  if (!(growth.alpha > 0.F)) growth.alpha = automaticAlpha(field.residual);
  const SheetEdges edges(points, field);
  segmentation::GrowthState state;
  state.neighborhoods = &neighborhoods;
  state.neighbors = std::min(neighborhoods.k(), kSheetDegree + 1);
  state.sheets = &edges;
  state.support = options.require_support ? kSupport : 0;
  segmentation::prepare(points, field, options.threads, state);
  segmentation::growSheets(growth, state);
  if (options.clean_up) {
    segmentation::CleanUp passes(growth, state);
    passes.absorbSmall();
    passes.extractEdges();
  }
  segmentation::setKinds(growth, state);
  Segmentation out = segmentation::rank(state, state.labels, state.signs);
  if (finished != nullptr) {
    float& offset = finished->typical_offset;
    offset = state.typical_offset = offset >= 0.F ? offset : state.typical_offset;
    // What goes over to a segment from now on follows no segment's sign any more.
    state.support = 0;
    segmentation::setCurvature(field.curvature, state);
    segmentation::cleanUp(finished->options, state);
    if (finished->options.unite_smooth) segmentation::uniteSmooth(finished->options, state);
    finished->segmentation =
        segmentation::finish(points, state, std::move(state.labels), std::move(state.signs));
  }
  state = {};
  segmentation::collectMembers(out);
  return out;
}

}  // namespace segorient
