// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/pipeline.h>

namespace segorient {

OrientationOptions paperOptions(OrientationMethod method) {
  OrientationOptions options;
  options.method = method;
  if (method == OrientationMethod::HOPPE) return options;  // the paper's as it is
  if (method != OrientationMethod::BOUNDARY) options.angle = SegmentAngle::REFERENCE_NORMALS;
  options.boundary = BoundaryTest::TRIANGULATED;
  options.triangulation.critical_factor = 1.F;
  options.triangulation.fill_gaps = false;
  options.check_borders = method == OrientationMethod::PROPAGATION;  // which has no such check
  options.turn_outward = false;
  return options;
}

PipelineOptions paperPipelineOptions(OrientationMethod method) {
  PipelineOptions options;
  options.normals.estimator = NormalEstimator::PLANE;
  options.segmentation.max_gap = 0.F;
  options.segmentation.max_offset = 0.F;
  options.segmentation.settle_edges = false;
  options.recomputations = 1;
  options.recomputation.rule = RecomputationRule::MODIFIED_NEIGHBORHOODS;
  options.recomputation.delta_between_references = true;
  options.orientation = paperOptions(method);
  return options;
}

}  // namespace segorient
