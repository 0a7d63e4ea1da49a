// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/orientation/pipeline.h>

#include "orientation/stage_clock.h"
#include "orientation/surface_stages.h"

namespace segorient::detail {

/// The options with those of version 1.0 that were set in the places that they have now.
PipelineOptions withFormerSettings(const PipelineOptions& options);

/// What the stages of orientCloud() find out about the distinct points of a cloud: normals and
/// segments oriented, and how.
struct OrientedStages {
  SurfaceStages surface;  ///< its cloud is prepared beforehand
  OrientationResult orientation;
};

/// The paper's stages (2.1 to 2.3.1), and its methods of orientation (3).
void runPaper(const PipelineOptions& options, StageClock& clock, OrientedStages& work,
              PipelineReport& report);

/// The default method, which brings its own stages.
/// \param points the cloud as it was given, whose order and gaps may tell of sensors
void runAutomatic(const PointView& points, const PipelineOptions& options, StageClock& clock,
                  OrientedStages& work, PipelineReport& report);

}  // namespace segorient::detail
