// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/orient_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/at.h"
#include "common/dot.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/coarse_levels.h"
#include "orientation/automatic/grazing_normals.h"
#include "orientation/automatic/sheet_filter.h"
#include "orientation/winding/winding_normals.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {
namespace {

// Takes the normals from points that do not see all of their neighbours.
void dropCutOff(const PointView& points, const Neighborhoods& nb, const std::vector<float>& whole,
                SheetNormals& sheets) {
  for (std::size_t i = 0; i < points.size; ++i) {
    const float* p = points[i];
    const float* q = points[static_cast<std::size_t>(nb.indices(i)[nb.count(i) - 1])];
    float square = 0.F;
    for (std::size_t a = 0; a < 3; ++a) square += (q[a] - p[a]) * (q[a] - p[a]);
    if (std::sqrt(square) <= whole[i]) continue;
    std::fill_n(&sheets.normals[4 * i], 4, std::numeric_limits<float>::quiet_NaN());
  }
}

// Normals that err alike side by side are no better for those around: these settle the sides only,
// unless it was seen which it is.
// \param toward as KnownSensors has it, or none
void keepLines(const std::vector<float>& own, const std::vector<float>& toward, int threads,
               std::vector<float>& filtered) {
  parallelFor(own.size() / 4, threads, 5.0, [&](std::size_t i) {
    const float* n = &own[4 * i];
    if (!(dot(n, n) > 0.F)) return;
    const bool seen = !toward.empty() && dot(&toward[3 * i], &toward[3 * i]) > 0.F;
    const float sign = !seen && dot(n, &filtered[4 * i]) < 0.F ? -1.F : 1.F;
    for (std::size_t a = 0; a < 3; ++a) filtered[4 * i + a] = sign * n[a];
  });
}

std::vector<std::uint8_t> lookAround(const SheetNormals& sheets, int threads) {
  // Residuals in spacings: what rounding leaves of a plane, and what curvature does.
  constexpr float kExact = 1e-4F;
  constexpr float kWithoutNoise = 0.01F;
  std::vector<std::uint8_t> out(sheets.spacing.size());
  parallelFor(out.size(), threads, 5.0, [&](std::size_t i) {
    const float residual = sheets.normals[4 * i + 3];
    unsigned bits = 0;
    if (residual < kExact) bits |= ONE_PLANE;
    if (residual < kWithoutNoise) bits |= ON_A_FACE;
    if (std::isfinite(sheets.below[i]) || std::isfinite(sheets.above[i])) bits |= SECOND_WALL;
    out[i] = static_cast<std::uint8_t>(bits);
  });
  return out;
}

// Segments of single sheets and the sign of each.
AutoOrientation orientSegments(const PointView& points, const Neighborhoods& neighborhoods,
                               const SheetNormals& sheets, const AutomaticOptions& settings,
                               const PointHints& hints, int threads,
                               const std::function<void(const char*, double)>& begin,
                               SheetRecord* record, FinishedSegments* finished) {
  const SheetField field = fieldOf(sheets);
  SheetSegmentationOptions cuts;
  cuts.alpha = settings.alpha;
  cuts.beta = settings.beta;
  cuts.epsilon = settings.epsilon;
  cuts.require_support = settings.require_support;
  cuts.clean_up = settings.clean_up;
  cuts.threads = threads;
  Segmentation segments = segmentSheets(points, neighborhoods, field, cuts, finished);
  if (begin) begin("orientation", 0.62);
  AutoOrientation out =
      record != nullptr && record->known
          ? record->known(segments, sheets.spacing)
          : orientSheets(points, neighborhoods, field, segments,
                         borderVotes(points, neighborhoods, field, segments, threads), points.size,
                         settings, hints, threads);
  if (record != nullptr) {
    if (!record->known) {
      record->votes = borderVotes(points, neighborhoods, field, segments, threads, record->voters);
    }
    record->segments = std::move(segments);
    record->sheets = sheets;
  }
  return out;
}

// The normals that are returned: turned, and bettered by what is around each point.
FilteredNormals finishNormals(MoreNeighbors& more, const Neighborhoods& neighborhoods,
                              const AutomaticOptions& settings, const AutoOrientation& orientation,
                              int threads, SheetNormals& sheets) {
  const PointView& points = more.points();
  parallelFor(points.size, threads, 5.0, [&](std::size_t i) {
    const auto sign = static_cast<float>(orientation.result.point_signs[i]);
    for (std::size_t a = 0; a < 3; ++a) sheets.normals[4 * i + a] *= sign;
  });
  std::vector<float> own;
  if (sheets.traits.onlyManyShowNoise()) own = sheets.normals;
  FilteredNormals filtered = filterOrientedNormals(
      points, neighborhoods, std::move(sheets.normals), sheets.spacing, sheets.residual,
      settings.filter_rounds, settings.filter_wedges, threads);
  if (!own.empty()) keepLines(own, orientation.toward, threads, filtered.normals);
  if (settings.winding_normals && settings.filter_rounds > 0) {
    refineByWinding(points, sheets.spacing, sheets.residual, !own.empty(), threads, filtered);
  }
  if (!orientation.toward.empty() && sheets.traits.scan_scales) {
    replaceGrazingNormals(more, orientation.toward, threads, filtered);
  }
  parallelFor(points.size, threads, 5.0, [&](std::size_t i) {
    float* n = &filtered.normals[4 * i];
    const bool has_normal = std::isfinite(n[0]);
    const float curvature =
        has_normal && !std::isfinite(sheets.curvature[i]) ? 0.F : sheets.curvature[i];
    n[3] = has_normal ? curvature : n[0];
  });
  return filtered;
}

AutoNormals orientAtOneScale(MoreNeighbors& more, const Neighborhoods& neighborhoods,
                             const AutomaticOptions& settings, const PointHints& hints, int threads,
                             const std::function<void(const char*, double)>& begin,
                             SheetRecord* record, FinishedSegments* finished) {
  const PointView& points = more.points();
  AutoNormals out;
  if (begin) begin("normals", 0.3);
  SheetNormalOptions normal_options;
  normal_options.split_walls = settings.split_walls;
  normal_options.dominant_plane = settings.dominant_plane;
  normal_options.threads = threads;
  // An even subset has lost how densely a sensor sees; its sensors are known already.
  normal_options.scan_scales =
      hints.toward.empty() && (hints.has_viewpoint || !hints.sensors.empty());
  if (record != nullptr) normal_options.known = record->traits;
  SheetNormals sheets = estimateSheetNormals(points, neighborhoods, normal_options, &more);
  out.spacing = median(sheets.spacing);
  if (record != nullptr) dropCutOff(points, neighborhoods, *record->whole, sheets);
  if (begin) begin("segmentation", 0.48);
  out.orientation = orientSegments(points, neighborhoods, sheets, settings, hints, threads, begin,
                                   record, finished);
  if (begin) begin("recomputation", 0.7);
  OrientationResult& result = out.orientation.result;
  out.around = lookAround(sheets, threads);
  FilteredNormals filtered =
      finishNormals(more, neighborhoods, settings, out.orientation, threads, sheets);
  out.normals = std::move(filtered.normals);
  out.confidences = std::move(filtered.confidences);
  out.sheets = sheets.traits;
  out.components = std::move(result.point_components);
  parallelFor(points.size, threads, 5.0, [&](std::size_t i) {
    const bool plane_around = out.confidences[i] > kAllAgree;
    if (!plane_around) out.around[i] = static_cast<std::uint8_t>(out.around[i] & ~ONE_PLANE);
    // The less of both: do the normals around agree, and is their segment sure? Of a part of a
    // cloud only the first is known yet.
    if (record == nullptr && out.components[i] >= 0) {
      out.confidences[i] = std::min(out.confidences[i], result.point_confidences[i]);
    }
  });
  result.point_confidences = {};
  return out;
}

}  // namespace

void turnInsideOut(AutoNormals& found) {
  const std::vector<std::uint8_t>& turned = found.orientation.inside_out;
  if (std::find(turned.begin(), turned.end(), 1) == turned.end()) return;
  for (std::size_t i = 0; i < found.components.size(); ++i) {
    if (found.components[i] < 0 || turned[at(found.components[i])] == 0) continue;
    float* n = &found.normals[4 * i];
    for (std::size_t a = 0; a < 3; ++a) n[a] = -n[a];
  }
}

AutoNormals orientPoints(MoreNeighbors& more, const Neighborhoods& neighborhoods,
                         const AutomaticOptions& settings, const PointHints& hints, int threads,
                         const std::function<void(const char*, double)>& begin, SheetRecord* record,
                         FinishedSegments* finished) {
  AutoNormals out =
      orientAtOneScale(more, neighborhoods, settings, hints, threads, begin, record, finished);
  // Whether a coarser scale is better is for the whole cloud to tell.
  // Where points have sensors of their own, those decide.
  const bool part = record != nullptr;
  if (part ? !record->coarser : !settings.coarse_levels || !hints.sensors.empty()) return out;
  const auto orient = [&](const PointView& subset, const Neighborhoods& table,
                          const PointHints& of_subset) {
    MoreNeighbors of_level(subset, threads);
    AutoNormals found =
        orientAtOneScale(of_level, table, settings, of_subset, threads, {}, nullptr, nullptr);
    turnInsideOut(found);
    return found;
  };
  // A coarser level knows nothing of what is around each point.
  const std::vector<std::uint8_t> around = out.around;
  const SheetTraits traits = out.sheets;
  if (part) {
    record->coarser(more.points(), out);
  } else {
    turnInsideOut(out);
    out.level = followCoarserLevels(more.points(), neighborhoods, hints, orient, threads, out);
    turnInsideOut(out);
  }
  if (out.level > 0.F) out.level_sheets = out.sheets;
  out.around = around;
  out.sheets = traits;
  return out;
}

}  // namespace segorient::detail
