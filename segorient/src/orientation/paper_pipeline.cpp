// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <cstdint>
#include <limits>

#include "orientation/cloud_scale.h"
#include "orientation/orient_segments.h"
#include "orientation/pipeline_stages.h"

namespace segorient::detail {
namespace {

// Turns the distinct points' normals and segments as they were oriented. The normals' own signs now
// say it all, so a point's sign in its segment is what is left: -1 where it disagrees with it.
void applyOrientation(OrientedStages& work) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const OrientationResult& orientation = work.orientation;
  std::vector<float>& normals = work.surface.normals;
  Segmentation& segmentation = work.surface.segmentation;
  for (std::size_t i = 0; i < work.surface.cloud.size(); ++i) {
    const auto sign = static_cast<float>(orientation.point_signs[i]);
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] *= sign == 0.F ? kNone : sign;
    if (sign == 0.F) normals[4 * i + 3] = kNone;
    const std::int32_t label = segmentation.labels[i];
    if (label < 0) continue;
    const int segment_sign = orientation.segments[static_cast<std::size_t>(label)].sign;
    segmentation.signs[i] =
        static_cast<std::int8_t>(segmentation.signs[i] * orientation.point_signs[i] * segment_sign);
  }
  for (std::size_t s = 0; s < segmentation.segments.size(); ++s) {
    for (float& c : segmentation.segments[s].reference_normal) {
      c *= static_cast<float>(orientation.segments[s].sign);
    }
  }
}

}  // namespace

void runPaper(const PipelineOptions& options, StageClock& clock, OrientedStages& work,
              PipelineReport& report) {
  SurfaceStages& surface = work.surface;
  const CloudScale scale = measureScale(surface.cloud.points(), surface.cloud.index());
  report.spacing = scale.spacing;
  report.noise = scale.noise;
  surface.findNeighbors(options.k > 0 ? options.k : neighborsForNoise(scale.noise));
  report.k = surface.k;
  clock.begin("normals", 0.4);
  surface.findNormals(options);
  report.normals_chosen = surface.normals_chosen;
  surface.recomputeNormals(options, clock);
  clock.begin("segmentation", 0.75);
  SegmentationOptions cuts{options.segmentation, 0, options.threads};
  cuts.unite_smooth = false;
  // A point of a thin part that is given to the other side's segment is turned over with it.
  cuts.settle_edges = false;
  surface.findSegments(cuts);
  clock.begin("orientation", 0.8);
  const OrientationOptions how{options.orientation, options.threads};
  const Neighborhoods& neighborhoods = surface.cloud.neighborhoods();
  work.orientation = orientSegments(surface.cloud.points(), surface.normalView(), neighborhoods,
                                    surface.segmentation, how);
  applyOrientation(work);
}

}  // namespace segorient::detail
