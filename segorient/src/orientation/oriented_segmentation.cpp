// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/impl/oriented_segmentation.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/refers_to.h"
#include "common/unit_vector.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/stages.h"
#include "orientation/follow_normals.h"
#include "orientation/orient_segments.h"
#include "search/prepared_cloud.h"
#include "segmentation/region_growing.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {
namespace {

// More neighbours cost time and memory and say nothing more about who borders whom.
constexpr int kMostNeighbors = 128;

int defaultNeighbors(const OrientationOptions& options) {
  return options.method == OrientationMethod::AUTO ? kSheetNeighbors : 12;
}

bool labelsInRange(const Segmentation& segmentation, std::size_t rows) {
  if (segmentation.labels.size() != rows || segmentation.signs.size() != rows) return false;
  const auto segments = static_cast<std::int64_t>(segmentation.segments.size());
  return std::all_of(segmentation.labels.begin(), segmentation.labels.end(),
                     [&](std::int32_t label) { return label < segments; });
}

// Results of the distinct points for all rows: a repeated point's normal may have either sign, so
// its sign is the one that turns it like the first.
OrientationResult scatter(const PreparedCloud& cloud, const PointView& normals,
                          const OrientationResult& of_points) {
  OrientationResult out;
  out.segments = of_points.segments;
  out.components = of_points.components;
  out.point_signs = cloud.scatter(of_points.point_signs, 1, std::int8_t{0});
  out.point_confidences = cloud.scatter(of_points.point_confidences, 1, 0.F);
  out.point_components = cloud.scatter(of_points.point_components, 1, std::int32_t{-1});
  for (std::size_t row = 0; row < cloud.rows(); ++row) {
    if (!isFinite(normals[row])) {
      out.point_signs[row] = 0;
      out.point_confidences[row] = 0.F;
      out.point_components[row] = -1;
    } else if (segmentation::isTurned(cloud, normals, row)) {
      out.point_signs[row] = static_cast<std::int8_t>(-out.point_signs[row]);
    }
  }
  return out;
}

// Inverts everything in segments that were turned over: their reference normals and, with these,
// what their points' signs refer to. Triangulations made from them then have their fronts outward.
void invertTurned(const std::vector<SegmentOrientationResult>& results,
                  Segmentation& segmentation) {
  for (std::size_t s = 0; s < results.size(); ++s) {
    if (results[s].sign >= 0) continue;
    for (float& c : segmentation.segments[s].reference_normal) c = -c;
  }
  for (std::size_t i = 0; i < segmentation.labels.size(); ++i) {
    const std::int32_t label = segmentation.labels[i];
    if (label < 0 || results[static_cast<std::size_t>(label)].sign >= 0) continue;
    segmentation.signs[i] = static_cast<std::int8_t>(-segmentation.signs[i]);
  }
}

}  // namespace

bool isTableOf(const Neighborhoods& table, std::size_t points) {
  return table.size() == points && table.k() > 1 && refersTo(table, points);
}

OrientedSegmentation orientSegmentation(const PointView& points, const NormalView& normals,
                                        const Segmentation* segmentation, int k,
                                        const SegmentationOptions& segmentation_options,
                                        const OrientationOptions& options,
                                        const PointSearch& search) {
  OrientedSegmentation out;
  if (normals.size != points.size) return out;
  if (segmentation != nullptr && !labelsInRange(*segmentation, points.size)) return out;

  PreparedCloud cloud(points, nullptr, options.threads);
  std::vector<float> point_normals = segmentation::gatherNormals(cloud, normals);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    unitVector(&point_normals[4 * i], &point_normals[4 * i]);
  }
  const NormalView normal_view{point_normals.data(), 4, cloud.size()};
  cloud.findNeighbors(std::min(kMostNeighbors, k > 0 ? k : defaultNeighbors(options)), search);
  const Neighborhoods& neighborhoods = cloud.neighborhoods();

  const bool automatic = options.method == OrientationMethod::AUTO;
  detail::AutoStages stages;
  if (automatic) {
    PipelineOptions settings;
    settings.k = k > 0 ? neighborhoods.k() - 1 : 0;
    settings.threads = options.threads;
    settings.segmentation = segmentation_options;
    settings.orientation = options;
    PointHints hints;
    if (options.hints) hints = resolveHints(*options.hints, cloud);
    stages = detail::runAutoStages(cloud, settings, hints, [](const char*, double) {});
  }
  Segmentation of_points;
  if (segmentation != nullptr) {
    of_points = segmentation::gather(cloud, point_normals, *segmentation);
  } else if (automatic) {
    of_points = std::move(stages.segmentation);
    giveSigns(normal_view, of_points);
  } else {
    SegmentationOptions cuts = segmentation::inUnitOf(cloud, segmentation_options);
    cuts.threads = options.threads;
    of_points = segmentByNormals(cloud.points(), normal_view, neighborhoods, cuts);
  }
  const OrientationResult of_distinct =
      automatic ? followNormals(cloud.points(), normal_view, neighborhoods, of_points,
                                options.turn_outward, stages)
                : orientSegments(cloud.points(), normal_view, neighborhoods, of_points, options);
  out.orientation = scatter(cloud, normals, of_distinct);
  out.segmentation =
      segmentation != nullptr ? *segmentation : segmentation::scatter(cloud, of_points, &normals);
  invertTurned(out.orientation.segments, out.segmentation);
  return out;
}

}  // namespace segorient
