// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/orient_points.h"

#include <algorithm>
#include <cmath>

#include "common/median.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/coarse_levels.h"
#include "orientation/automatic/grazing_normals.h"
#include "orientation/automatic/sensor_signs.h"
#include "orientation/automatic/sheet_filter.h"
#include "orientation/winding/winding_normals.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {
namespace {

AutoNormals orientAtOneScale(const PointView& points, const Neighborhoods& neighborhoods,
                             const AutomaticOptions& settings, const PointHints& hints, int threads,
                             const std::function<void(const char*, double)>& begin) {
  AutoNormals out;
  if (begin) begin("normals", 0.3);
  SheetNormalOptions normal_options{settings.split_walls, settings.dominant_plane, threads};
  normal_options.scan_scales = hints.has_viewpoint || !hints.sensors.empty();
  SheetNormals sheets = estimateSheetNormals(points, neighborhoods, normal_options);
  out.spacing = median(sheets.spacing);
  if (begin) begin("segmentation", 0.48);
  {
    const SheetField field = fieldOf(sheets);
    SheetSegmentationOptions cuts;
    cuts.alpha = settings.alpha;
    cuts.beta = settings.beta;
    cuts.epsilon = settings.epsilon;
    cuts.require_support = settings.require_support;
    cuts.clean_up = settings.clean_up;
    const Segmentation segments = segmentSheets(
        points, neighborhoods, field, admissibleEdges(points, neighborhoods, field, threads), cuts);
    if (begin) begin("orientation", 0.62);
    out.orientation =
        orientSheets(points, neighborhoods, field, segments, settings, hints, threads);
  }
  if (begin) begin("recomputation", 0.7);
  const OrientationResult& result = out.orientation.result;
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto sign = static_cast<float>(result.point_signs[i]);
    for (std::size_t a = 0; a < 3; ++a) sheets.normals[4 * i + a] *= sign;
  }
  FilteredNormals filtered =
      filterOrientedNormals(points, neighborhoods, sheets.normals, sheets.spacing, sheets.residual,
                            settings.filter_rounds, settings.filter_wedges, threads);
  if (settings.winding_normals && settings.filter_rounds > 0) {
    refineByWinding(points, sheets.spacing, sheets.residual, threads, filtered);
  }
  if (!out.orientation.toward.empty()) {
    faceSensors(out.orientation.toward, filtered);
    if (sheets.scan_scales) {
      replaceGrazingNormals(points, out.orientation.toward, threads, filtered);
    }
  }
  out.normals = std::move(filtered.normals);
  for (std::size_t i = 0; i < points.size; ++i) {
    const bool has_normal = std::isfinite(out.normals[4 * i]);
    const float curvature =
        has_normal && !std::isfinite(sheets.curvature[i]) ? 0.F : sheets.curvature[i];
    out.normals[4 * i + 3] = has_normal ? curvature : out.normals[4 * i];
  }
  out.confidences = std::move(filtered.confidences);
  out.components = result.point_components;
  for (std::size_t i = 0; i < points.size; ++i) {
    // The less of both: do the normals around agree, and is their segment sure?
    if (result.point_components[i] >= 0) {
      out.confidences[i] = std::min(out.confidences[i], result.point_confidences[i]);
    }
  }
  return out;
}

}  // namespace

AutoNormals orientPoints(const PointView& points, const Neighborhoods& neighborhoods,
                         const AutomaticOptions& settings, const PointHints& hints, int threads,
                         const std::function<void(const char*, double)>& begin) {
  AutoNormals out = orientAtOneScale(points, neighborhoods, settings, hints, threads, begin);
  if (!settings.coarse_levels || !hints.noneOfPoints()) return out;
  const auto orient = [&](const PointView& subset, const Neighborhoods& table) {
    return orientAtOneScale(subset, table, settings, hints, threads, {});
  };
  out.level = followCoarserLevels(points, neighborhoods, orient, threads, out);
  return out;
}

}  // namespace segorient::detail
