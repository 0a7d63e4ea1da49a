// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/surface_stages.h"

#include <cstdint>
#include <string>
#include <utility>

#include "features/automatic_normals.h"
#include "features/local_normals.h"
#include "features/recompute_normals.h"
#include "features/scan_normals.h"
#include "features/scan_scale.h"
#include "features/sheet_normals.h"
#include "orientation/sensors/sensor_search.h"
#include "segmentation/region_growing.h"
#include "segmentation/segmentation_rows.h"

namespace segorient::detail {

void SurfaceStages::findNormals(const PipelineOptions& options) {
  normals.resize(4 * cloud.size());
  if (options.normals.estimator == NormalEstimator::AUTO) {
    findNormalsAutomatically(options);
    return;
  }
  const LocalNormalOptions settings{options.normals, 0, options.threads};
  estimateNormals(cloud.points(), cloud.neighborhoods(), settings, normals.data());
  normals_chosen = "as asked for";
}

void SurfaceStages::findNormalsAutomatically(const PipelineOptions& options) {
  const PointView points = cloud.points();
  const int threads = options.threads;
  if (options.k > 0) {
    normals_chosen =
        estimateNormalsAutomatically(points, cloud.neighborhoods(), threads, normals.data()).text();
    return;
  }
  normals_chosen = estimateNormalsAutomatically(points, cloud.index(), cloud.neighborhoods(),
                                                threads, normals.data())
                       .text();
  SensorOptions sensors;
  sensors.threads = threads;
  if (options.orientation.hints) sensors.suggestions = options.orientation.hints->suggested;
  SeenShadows shadows;
  const bool seen = options.orientation.automatic.find_sensors &&
                    sensorsOf(points, cloud, sensors, shadows).sure();
  if (!seen && !showsScanLines(points, cloud.index(), threads)) return;
  Neighborhoods wider;
  cloud.index().nearestKAll(kSheetNeighbors + 1, wider, false);
  MoreNeighbors more(points, threads, cloud.takeIndex());
  const std::size_t taken = takeScanPlanes(more, wider, threads, normals);
  if (taken > 0) {
    normals_chosen +=
        "; " + std::to_string(taken) + " points by planes of more neighbours, as scans ask for";
  }
}

void SurfaceStages::findSegments(const SegmentationOptions& options) {
  Segmentation faces;
  segmentation = segmentByNormals(cloud.points(), normalView(), cloud.neighborhoods(),
                                  segmentation::inUnitOf(cloud, options), nullptr,
                                  options.unite_smooth ? &faces : nullptr);
  if (options.unite_smooth) segmentation = std::move(faces);
}

void SurfaceStages::recomputeNormals(const PipelineOptions& options, StageClock& clock) {
  const RecomputationOptions settings{options.recomputation, options.normals.estimator, 0,
                                      options.threads};
  SegmentationOptions cuts{options.segmentation};
  cuts.threads = options.threads;
  cuts.unite_smooth = false;
  for (int round = 0; round < options.recomputations; ++round) {
    clock.begin("segmentation", 0.5);
    findSegments(cuts);
    clock.begin("recomputation", 0.65);
    std::vector<std::uint8_t> regular;
    for (const Segment& segment : segmentation.segments) {
      regular.push_back(segment.kind == SegmentKind::REGULAR ? 1 : 0);
    }
    segorient::recomputeNormals(cloud.points(), cloud.neighborhoods(), regular, settings,
                                segmentation.labels, normals);
  }
}

}  // namespace segorient::detail
