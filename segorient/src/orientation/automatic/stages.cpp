// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/stages.h"

#include <segorient/search/median_hash_index.h>

#include <cmath>

#include "features/sheet_denoise.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/final_normals.h"
#include "orientation/automatic/sensor_normals.h"
#include "segmentation/region_growing.h"
#include "segmentation/segmentation_rows.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {
namespace {

// Enough for a plane through a slab of one or two spacings of noise.
constexpr int kDenoisingNeighbors = 48;

// Finds the neighbours, of smoothed positions where the noise asks for that.
// \param smoothed stays empty where it does not
void findNeighbors(PreparedCloud& cloud, const PipelineOptions& options, const SheetRecord* record,
                   std::vector<float>& smoothed, Neighborhoods& of_smoothed, AutoStages& out) {
  out.k = cloud.findNeighbors(options.k > 0 ? options.k : kSheetNeighbors, false);
  const NoiseLevel noise =
      record != nullptr ? record->traits.noise
                        : measureNoise(cloud.points(), cloud.neighborhoods(), options.threads);
  out.noise = noise.fine;
  out.denoised = record != nullptr ? record->denoise
                                   : options.orientation.automatic.denoise && needsDenoising(noise);
  if (out.denoised) {
    smoothed = projectOnPlanes(cloud.points(), cloud.index(), kDenoisingNeighbors, options.threads);
    search::MedianHashIndex index;
    search::MedianHashIndex::Options search_options;
    search_options.threads = options.threads;
    index.build({smoothed.data(), 4, cloud.size()}, nullptr, search_options);
    index.nearestKAll(out.k + 1, of_smoothed, false);
  }
  cloud.dropIndex();
}

// Segments of the oriented normals, turned as most of their points are.
void segmentOriented(const PointView& points, const Neighborhoods& table,
                     SegmentationOptions settings, int threads, const AutoNormals& oriented,
                     AutoStages& out) {
  settings.neighbors = kSheetDegree;
  settings.threads = threads;
  out.segmentation =
      segmentByNormals(points, {oriented.normals.data(), 4, points.size}, table, settings);
  Segmentation& segmentation = out.segmentation;
  out.segments.resize(segmentation.segments.size());
  for (std::size_t s = 0; s < segmentation.segments.size(); ++s) {
    long balance = 0;
    double confidence = 0.0;
    for (const auto* p = segmentation.begin(s); p != segmentation.end(s); ++p) {
      balance += segmentation.signs[static_cast<std::size_t>(*p)];
      confidence += static_cast<double>(oriented.confidences[static_cast<std::size_t>(*p)]);
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
    result.component = oriented.components[static_cast<std::size_t>(*segmentation.begin(s))];
    result.hard = confidence <= 0.0;
  }
}

}  // namespace

AutoStages runAutoStages(PreparedCloud& cloud, const PipelineOptions& options,
                         const PointHints& hints,
                         const std::function<void(const char*, double)>& begin,
                         SheetRecord* record) {
  AutoStages out;
  begin("search", 0.0);
  std::vector<float> smoothed;
  Neighborhoods of_smoothed;
  findNeighbors(cloud, options, record, smoothed, of_smoothed, out);
  const PointView points =
      out.denoised ? PointView{smoothed.data(), 4, cloud.size()} : cloud.points();
  const Neighborhoods& table = out.denoised ? of_smoothed : cloud.neighborhoods();
  const AutomaticOptions& settings = options.orientation.automatic;
  AutoNormals oriented =
      orientPoints(points, table, settings, hints, options.threads, begin, record);
  begin("segmentation", 0.78);
  segmentOriented(points, table, segmentation::inUnitOf(cloud, options.segmentation),
                  options.threads, oriented, out);
  if (settings.fit_normals && !out.denoised && !oriented.scan_scales) {
    begin("recomputation", 0.88);
    out.final_traits =
        fitFinalNormals(cloud, out.segmentation, options.k > 0, options.threads,
                        record != nullptr ? &record->final_traits : nullptr, oriented);
  }
  if (!oriented.orientation.toward.empty()) {
    leanToSensors(points, table, oriented.orientation.toward, options.threads, oriented.normals);
  }
  out.normals = std::move(oriented.normals);
  out.confidences = std::move(oriented.confidences);
  out.components = std::move(oriented.components);
  out.orientation = std::move(oriented.orientation);
  out.spacing = oriented.spacing;
  out.level = oriented.level;
  out.sheets = oriented.sheets;
  if (record != nullptr) record->smoothed = std::move(smoothed);
  return out;
}

}  // namespace segorient::detail
