// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/first_stages.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "common/peak_memory.h"
#include "features/sheet_normals.h"
#include "orientation/pipeline_stages.h"
#include "orientation/sensors/sensor_hints.h"
#include "orientation/stage_clock.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// From points to input rows, lengths back to the input's unit.
void scatter(const detail::OrientedStages& work, OrientedCloud& out) {
  const PreparedCloud& cloud = work.surface.cloud;
  out.normals = cloud.scatter(work.surface.normals, 4, kNaN);
  out.confidences = cloud.scatter(work.orientation.point_confidences, 1, 0.F);
  out.components = cloud.scatter(work.orientation.point_components, 1, std::int32_t{-1});
  out.segmentation = segmentation::scatter(cloud, work.surface.segmentation);
  out.segments = work.orientation.segments;
  out.report.spacing *= cloud.unit();
  for (Contradiction& c : out.report.contradictions) {
    for (float& v : c.where) v *= cloud.unit();
  }
  for (KnownSensor& s : out.report.known_sensors) {
    for (float& v : s.position) v *= cloud.unit();
  }
}

void fillReport(const detail::OrientedStages& work, const OrientedCloud& cloud,
                PipelineReport& report) {
  report.points = work.surface.cloud.rows();
  report.non_finite = work.surface.cloud.withoutPoint();
  report.duplicates = work.surface.cloud.duplicates();
  for (std::size_t row = 0; row < cloud.confidences.size(); ++row) {
    if (!std::isfinite(cloud.normals[4 * row])) ++report.without_normal;
  }
  for (std::size_t s = 0; s < cloud.segments.size(); ++s) {
    const SegmentKind kind = cloud.segmentation.segments[s].kind;
    report.regular_segments += kind == SegmentKind::REGULAR;
    report.connected_segments += kind == SegmentKind::CONNECTED;
    report.isolated_segments += kind == SegmentKind::ISOLATED;
    if (cloud.segments[s].hard) ++report.hard_segments;
  }
  report.components = work.orientation.components;
  report.peak_memory = peakMemory();
}

// Where only some rows were asked for: what the report says about rows is about those.
void countRows(const PreparedCloud& cloud, const std::vector<pcl::index_t>& indices,
               PipelineReport& report) {
  report.points = indices.size();
  report.non_finite =
      static_cast<std::size_t>(std::count_if(indices.begin(), indices.end(), [&](pcl::index_t row) {
        return row < 0 || static_cast<std::size_t>(row) >= cloud.rows() ||
               cloud.pointOf(static_cast<std::size_t>(row)) < 0;
      }));
  report.duplicates = report.points - report.non_finite - cloud.size();
}

// Segments by the paper's stages alone.
OrientedCloud firstStages(const PointView& points, const PipelineOptions& options,
                          const PipelineProgress& progress) {
  FirstStages stages(points, options, progress);
  stages.findNormals();
  stages.findSegments();
  OrientedCloud out;
  out.normals = stages.normals();
  out.segmentation = stages.segmentation();
  out.report.points = points.size;
  out.report.non_finite = stages.nonFinite();
  out.report.duplicates = stages.duplicates();
  out.report.k = stages.k();
  out.report.normals_chosen = stages.normalsChosen();
  out.report.stages = stages.times();
  return out;
}

}  // namespace

OrientedCloud orientCloud(const PointView& points, const std::vector<pcl::index_t>* indices,
                          const PipelineOptions& given, const PipelineProgress& progress) {
  const PipelineOptions options = detail::withFormerSettings(given);
  OrientedCloud out;
  out.report.method = options.orientation.method;
  out.report.estimator = options.normals.estimator;
  detail::StageClock clock(progress);
  detail::OrientedStages work;
  // Fractions: shares of the time on clouds of a million points.
  clock.begin("search", 0.0);
  work.surface.cloud = PreparedCloud(points, indices, options.threads);
  if (options.orientation.method == OrientationMethod::AUTO) {
    detail::runAutomatic(points, options, clock, work, out.report);
  } else {
    detail::runPaper(options, clock, work, out.report);
  }
  clock.begin("output", 0.95);
  scatter(work, out);
  if (indices != nullptr) out = selectRows(out, *indices);
  fillReport(work, out, out.report);
  if (indices != nullptr) countRows(work.surface.cloud, *indices, out.report);
  clock.end();
  out.report.stages = clock.times();
  for (const StageTime& stage : out.report.stages) out.report.seconds += stage.seconds;
  if (progress) progress("output", 1.0);
  return out;
}

OrientedCloud segmentCloud(const PointView& points, const PipelineOptions& options,
                           const PipelineProgress& progress) {
  const bool automatic = options.orientation.method == OrientationMethod::AUTO;
  const bool own_normals =
      options.normals.estimator != NormalEstimator::AUTO || options.recomputations > 0;
  OrientedCloud out = automatic && own_normals ? firstStages(points, options, progress)
                                               : orientCloud(points, nullptr, options, progress);
  for (std::size_t row = 0; row < out.segmentation.signs.size(); ++row) {
    std::int8_t& sign = out.segmentation.signs[row];
    for (std::size_t a = 0; a < 3 && sign < 0; ++a) out.normals[4 * row + a] *= -1.F;
    sign = std::abs(sign);
  }
  return out;
}

std::size_t expectedMemory(std::size_t points, const PipelineOptions& options) {
  const bool automatic = options.orientation.method == OrientationMethod::AUTO;
  constexpr int kMostByNoise = 30;
  const auto k = static_cast<std::size_t>(options.k > 0 ? options.k
                                          : automatic   ? kSheetNeighbors
                                                        : kMostByNoise);
  // The table of neighbours, with distances where the paper's methods want them, and all else, as
  // measured on clouds of one to ten million points.
  const std::size_t entry = automatic ? sizeof(pcl::index_t) : sizeof(pcl::index_t) + sizeof(float);
  constexpr std::size_t kElse = 180;
  // Noise beyond a spacing takes smoothed positions, and their neighbours, as well.
  const std::size_t smoothed =
      automatic && options.orientation.automatic.denoise ? entry * (k + 1) + 4 * sizeof(float) : 0;
  // Who saw what is checked in the sensor's view.
  const OrientationHints* hints = options.orientation.hints.get();
  const bool seen = automatic && hints != nullptr && detail::saysSensors(*hints);
  constexpr std::size_t kOfSensors = 100;
  return points * (entry * (k + 1) + smoothed + kElse + (seen ? kOfSensors : 0));
}

OrientedCloud selectRows(const OrientedCloud& cloud, const std::vector<pcl::index_t>& rows) {
  OrientedCloud out;
  out.report = cloud.report;
  out.segments = cloud.segments;
  out.segmentation.segments = cloud.segmentation.segments;
  out.normals.assign(4 * rows.size(), kNaN);
  out.confidences.assign(rows.size(), 0.F);
  out.components.assign(rows.size(), -1);
  out.segmentation.labels.assign(rows.size(), -1);
  out.segmentation.signs.assign(rows.size(), 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0 || static_cast<std::size_t>(rows[i]) >= cloud.confidences.size()) continue;
    const auto row = static_cast<std::size_t>(rows[i]);
    std::copy_n(&cloud.normals[4 * row], 4, &out.normals[4 * i]);
    out.confidences[i] = cloud.confidences[row];
    out.components[i] = cloud.components[row];
    out.segmentation.labels[i] = cloud.segmentation.labels[row];
    out.segmentation.signs[i] = cloud.segmentation.signs[row];
  }
  segmentation::collectMembers(out.segmentation);
  return out;
}

}  // namespace segorient
