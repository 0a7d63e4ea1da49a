// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "auto_stages.h"

#include <segorient/common/median.h>
#include <segorient/features/sheet_denoise.h>
#include <segorient/features/sheet_normals.h>
#include <segorient/orientation/sheet_filter.h>
#include <segorient/orientation/winding_normals.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>

namespace segorient::detail {
namespace {

// Enough for a plane through a slab of one or two spacings of noise.
constexpr int kDenoisingNeighbors = 48;

struct Neighbors {
  std::vector<float> smoothed;  // positions, where they were denoised
  Neighborhoods table;
};

PointView positions(const CompactCloud& cloud, const Neighbors& neighbors) {
  return neighbors.smoothed.empty() ? cloud.view()
                                    : PointView{neighbors.smoothed.data(), 4, cloud.size()};
}

Neighbors findNeighbors(const CompactCloud& cloud, const PipelineOptions& options,
                        AutoStages& out) {
  const std::size_t others = cloud.size() > 0 ? cloud.size() - 1 : 0;
  const auto wanted = static_cast<std::size_t>(options.k > 0 ? options.k : kSheetNeighbors);
  out.k = static_cast<int>(std::min(wanted, others));
  search::MedianHashIndex::Options search_options;
  search_options.threads = options.threads;
  Neighbors neighbors;
  search::MedianHashIndex index;
  index.build(cloud.view(), nullptr, search_options);
  index.nearestKAll(out.k + 1, neighbors.table, false);
  const NoiseLevel noise = measureNoise(cloud.view(), neighbors.table, options.threads);
  out.noise = noise.fine;
  if (!options.denoise || !needsDenoising(noise)) return neighbors;
  out.denoised = true;
  neighbors.smoothed = projectOnPlanes(cloud.view(), index, kDenoisingNeighbors, options.threads);
  index.build(positions(cloud, neighbors), nullptr, search_options);
  index.nearestKAll(out.k + 1, neighbors.table, false);
  return neighbors;
}

// Segments of the final normals, turned as most of their points are.
void segmentFinal(const PointView& points, const Neighborhoods& table,
                  const PipelineOptions& options, AutoStages& out) {
  SegmentationOptions settings = options.segmentation;
  settings.neighbors = kSheetDegree;
  settings.threads = options.threads;
  out.segmentation =
      segmentByNormals(points, {out.normals.data(), 4, points.size}, table, settings);
  Segmentation& segmentation = out.segmentation;
  out.segments.resize(segmentation.segments.size());
  for (std::size_t s = 0; s < segmentation.segments.size(); ++s) {
    long balance = 0;
    double confidence = 0.0;
    for (const auto* p = segmentation.begin(s); p != segmentation.end(s); ++p) {
      balance += segmentation.signs[static_cast<std::size_t>(*p)];
      confidence += static_cast<double>(out.confidences[static_cast<std::size_t>(*p)]);
    }
    if (balance < 0) {
      for (const auto* p = segmentation.begin(s); p != segmentation.end(s); ++p) {
        auto& sign = segmentation.signs[static_cast<std::size_t>(*p)];
        sign = static_cast<std::int8_t>(-sign);
      }
      for (float& c : segmentation.segments[s].reference_normal) c = -c;
    }
    const auto size =
        static_cast<double>(std::max<std::uint32_t>(1, segmentation.segments[s].size));
    const double unanimous = std::fabs(static_cast<double>(balance)) / size;
    SegmentOrientationResult& result = out.segments[s];
    result.sign = 1;
    result.by = DecidedBy::GLOBAL;
    result.confidence = static_cast<float>(confidence / size * unanimous);
    result.component = out.components[static_cast<std::size_t>(*segmentation.begin(s))];
    result.hard = confidence <= 0.0;
  }
}

}  // namespace

AutoNormals orientPoints(const PointView& points, const Neighborhoods& neighborhoods,
                         const PipelineOptions& options, const PointHints& hints,
                         const std::function<void(const char*, double)>& begin) {
  AutoNormals out;
  if (begin) begin("normals", 0.3);
  SheetNormalOptions normal_options = options.sheet_normals;
  normal_options.threads = options.threads;
  SheetNormals sheets = estimateSheetNormals(points, neighborhoods, normal_options);
  out.spacing = median(sheets.spacing);
  if (begin) begin("segmentation", 0.48);
  {
    const SheetField field = fieldOf(sheets);
    AutoOrientationOptions settings = options.automatic;
    settings.threads = options.threads;
    const Segmentation segments = segmentSheets(
        points, neighborhoods, field,
        admissibleEdges(points, neighborhoods, field, options.threads), options.sheets);
    if (begin) begin("orientation", 0.62);
    out.orientation = orientSheets(points, neighborhoods, field, segments, settings, hints);
  }
  if (begin) begin("recomputation", 0.7);
  const OrientationResult& result = out.orientation.result;
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto sign = static_cast<float>(result.point_signs[i]);
    for (std::size_t a = 0; a < 3; ++a) sheets.normals[4 * i + a] *= sign;
  }
  FilteredNormals filtered =
      filterOrientedNormals(points, neighborhoods, sheets.normals, sheets.spacing, sheets.residual,
                            options.filter_rounds, options.filter_wedges, options.threads);
  if (options.winding_normals && options.filter_rounds > 0) {
    refineByWinding(points, sheets.spacing, sheets.residual, options.threads, filtered);
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

AutoStages runAutoStages(const CompactCloud& cloud, const PipelineOptions& options,
                         const PointHints& hints,
                         const std::function<void(const char*, double)>& begin) {
  AutoStages out;
  begin("search", 0.0);
  const Neighbors neighbors = findNeighbors(cloud, options, out);
  const PointView points = positions(cloud, neighbors);
  AutoNormals oriented = orientPoints(points, neighbors.table, options, hints, begin);
  out.normals = std::move(oriented.normals);
  out.confidences = std::move(oriented.confidences);
  out.components = std::move(oriented.components);
  out.orientation = std::move(oriented.orientation);
  out.spacing = oriented.spacing;
  begin("segmentation", 0.81);
  segmentFinal(points, neighbors.table, options, out);
  return out;
}

}  // namespace segorient::detail
