// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/orientation/pipeline.h>

#include <functional>
#include <vector>

#include "orientation/automatic/orient_points.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// What the default method found out about the distinct points of a cloud.
struct AutoStages : AutoNormals {
  Segmentation segmentation;                       ///< reference normals and signs oriented
  std::vector<SegmentOrientationResult> segments;  ///< by label of `segmentation`
  int k = 0;
  float noise = 0.F;        ///< see NoiseLevel::fine
  bool denoised = false;    ///< whether positions were smoothed first
  bool consistent = false;  ///< see NoiseField
  bool fine_field = false;  ///< see NoiseField::fine
  FinalTraits final_traits;
  float typical_offset = 0.F;  ///< see FinishedSegments
};

/// The default method, from distinct points to oriented normals and segments: neighbours, sheet
/// normals, sheet segments, their orientation, the filter that settles the signs, the paper's
/// segmentation of that, and the final normals. \param begin called with a stage's name and the
/// fraction of the work done before it
/// \param record null unless the cloud is part of a larger one
SEGORIENT_ORIENTATION_EXPORT AutoStages
runAutoStages(PreparedCloud& cloud, const PipelineOptions& options, const PointHints& hints,
              const std::function<void(const char*, double)>& begin, SheetRecord* record = nullptr);

}  // namespace segorient::detail
