// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/stages.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>

#include "common/dot.h"
#include "common/parallel_for.h"
#include "features/sheet_denoise.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/final_labels.h"
#include "orientation/automatic/final_normals.h"
#include "orientation/automatic/noise_field.h"
#include "orientation/automatic/patch_signs.h"
#include "orientation/automatic/sensor_normals.h"
#include "orientation/automatic/sparse_bodies.h"
#include "orientation/winding/winding_normals.h"
#include "search/index_of.h"
#include "segmentation/segmentation_rows.h"

namespace segorient::detail {
namespace {

// Enough for a plane through a slab of one or two spacings of noise.
constexpr int kDenoisingNeighbors = 48;

// Finds the neighbours unless they are known, and those of smoothed positions where the noise asks
// for that.
// \param smoothed stays empty where it does not
void findNeighbors(PreparedCloud& cloud, const PipelineOptions& options, const SheetRecord* record,
                   std::vector<float>& smoothed, Neighborhoods& of_smoothed, AutoStages& out) {
  out.k = options.k > 0 ? options.k : kSheetNeighbors;
  const auto entries =
      static_cast<int>(std::min(cloud.size(), static_cast<std::size_t>(out.k) + 1));
  const bool known = cloud.size() > 0 && cloud.neighborhoods().size() == cloud.size() &&
                     cloud.neighborhoods().k() == entries;
  out.k = known ? entries - 1 : cloud.findNeighbors(out.k, false);
  const NoiseLevel noise =
      record != nullptr ? record->traits.noise
                        : measureNoise(cloud.points(), cloud.neighborhoods(), options.threads);
  out.noise = noise.fine;
  out.denoised = record != nullptr ? record->denoise
                                   : options.orientation.automatic.denoise && needsDenoising(noise);
  if (out.denoised) {
    smoothed = projectOnPlanes(cloud.points(), cloud.index(), kDenoisingNeighbors, options.threads);
    search::indexOf({smoothed.data(), 4, cloud.size()}, options.threads)
        .nearestKAll(out.k + 1, of_smoothed, false);
    cloud.dropIndex();
  }
}

// Turns the segments as most of their points are.
void turnSegments(int threads, AutoStages& out) {
  Segmentation& segmentation = out.segmentation;
  segmentation::collectMembers(segmentation);
  out.segments.resize(segmentation.segments.size());
  const double time = timeOfEach(out.segments.size(), segmentation.members.size(), 20.0);
  parallelFor(out.segments.size(), threads, time, [&](std::size_t s) {
    Segment& segment = segmentation.segments[s];
    long balance = 0;
    double confidence = 0.0;
    for (const auto* p = segmentation.begin(s); p != segmentation.end(s); ++p) {
      const auto i = static_cast<std::size_t>(*p);
      const bool agrees = dot(&out.normals[4 * i], segment.reference_normal.data()) >= 0.F;
      segmentation.signs[i] = agrees ? std::int8_t{1} : std::int8_t{-1};
      balance += segmentation.signs[i];
      confidence += static_cast<double>(out.confidences[i]);
    }
    if (balance < 0) {
      for (const auto* p = segmentation.begin(s); p != segmentation.end(s); ++p) {
        auto& sign = segmentation.signs[static_cast<std::size_t>(*p)];
        sign = static_cast<std::int8_t>(-sign);
      }
      for (float& c : segment.reference_normal) c = -c;
    }
    const auto size = static_cast<double>(std::max<std::uint32_t>(1, segment.size));
    const double unanimous = std::fabs(static_cast<double>(balance)) / size;
    SegmentOrientationResult& result = out.segments[s];
    result.sign = 1;
    result.by = DecidedBy::GLOBAL;
    result.confidence = static_cast<float>(confidence / size * unanimous);
    result.component = out.components[static_cast<std::size_t>(*segmentation.begin(s))];
    result.hard = confidence <= 0.0;
  });
}

// What the winding number says of the signs, where nothing is known of sensors.
// \param points of the cloud, smoothed or not \param table of their neighbours
void askField(const PreparedCloud& cloud, const PointView& points, const Neighborhoods& table,
              const PointHints& hints, int threads, AutoStages& out) {
  const bool noisy = out.noise >= kFewTellNothing;
  const bool at_level = out.level > 0.F;
  const bool alone = out.orientation.toward.empty();
  CellSigns bodies;
  if (alone && !at_level) {
    bodies = findCellSigns(points, out.normals, out.spacing, out.orientation, noisy, threads);
  }
  if (contradictHints(points, bodies, out.normals, out.components, out.orientation.inside_out,
                      hints)) {
    bodies = {};
  }
  takeCellSigns(points, bodies, out);
  // The field of all points knows nothing of faces in contact.
  const bool in_contact = !bodies.empty();
  if ((noisy || at_level) && !in_contact) {
    NoiseField field = findNoiseField(cloud.points(), cloud.neighborhoods(), out.normals, threads,
                                      out.confidences);
    if (!noisy) field.averaged_below = kAcross;
    out.consistent = field.consistent;
    out.fine_field = field.fine;
    takeNoiseField(cloud.points(), cloud.neighborhoods(), field, threads, out);
  } else if (!noisy && !at_level && alone && !out.scales.empty()) {
    // Judged scales: signs contradict each other somewhere.
    takeFineField(points, table, threads, out);
  }
  // Nor of seeds and normals that are given, which may know of other sides. Where positions were
  // smoothed there is too much noise.
  const bool nothing_given = alone && hints.seeds.empty() && hints.directions.empty();
  if (nothing_given && !in_contact && !out.denoised) {
    takeSparseField(cloud.points(), cloud.neighborhoods(), out.noise, threads, out);
  }
}

// Where sensors tell the sides, the field of all points tells lines beside edges in noise.
void askFieldForLines(const PreparedCloud& cloud, int threads, AutoStages& out) {
  // Fewer points that may be mended are not worth the time that the field takes.
  constexpr double kFewDoubtful = 0.01;
  if (out.noise < kCleanFit || out.orientation.toward.empty()) return;
  const auto doubtful = std::count_if(out.confidences.begin(), out.confidences.end(),
                                      [](float c) { return c < kNothingToMend; });
  if (static_cast<double>(doubtful) < kFewDoubtful * static_cast<double>(cloud.size())) return;
  const NoiseField field = findNoiseField(cloud.points(), cloud.neighborhoods(), out.normals,
                                          threads, {}, KnownField{true, false});
  takeFieldLines(cloud.points(), field, threads, out.normals);
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
  FinishedSegments finished;
  finished.options = segmentation::inUnitOf(cloud, {options.segmentation});
  finished.options.threads = options.threads;
  if (record != nullptr) finished.typical_offset = record->typical_offset;
  MoreNeighbors more(points, options.threads, cloud.takeIndex());
  static_cast<AutoNormals&>(out) =
      orientPoints(more, table, settings, hints, options.threads, begin, record, &finished);
  out.segmentation = std::move(finished.segmentation);
  out.typical_offset = finished.typical_offset;
  if (record != nullptr) {
    if (record->field) record->field(points, out);
  } else if (settings.winding_normals && hints.leaveSidesToField()) {
    turnInsideOut(out);
    askField(cloud, points, table, hints, options.threads, out);
    turnInsideOut(out);
  }
  if (settings.winding_normals) askFieldForLines(cloud, options.threads, out);
  labelTheRest(table, out.normals, out.segmentation);
  if (settings.fit_normals && !out.denoised && !out.sheets.onlyManyShowNoise()) {
    begin("recomputation", 0.88);
    out.final_traits =
        fitFinalNormals(cloud, more, out.segmentation, options.k > 0, options.threads,
                        record != nullptr ? &record->final_traits : nullptr, out);
  }
  if (!out.orientation.toward.empty()) {
    leanToSensors(more, table, out.orientation.toward, out.sure, out.sheets.onlyManyShowNoise(),
                  options.threads, out.normals);
  }
  followFinalNormals(table, out.normals, options.threads, out.segmentation);
  turnSegments(options.threads, out);
  if (record != nullptr) record->smoothed = std::move(smoothed);
  return out;
}

}  // namespace segorient::detail
