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
struct AutoStages {
  std::vector<float> normals;      ///< 4 floats a point: oriented normal, curvature; NaN where none
  std::vector<float> confidences;  ///< of the orientation, 0 to 1
  std::vector<std::int32_t> components;            ///< -1 where there is no normal
  Segmentation segmentation;                       ///< reference normals and signs oriented
  std::vector<SegmentOrientationResult> segments;  ///< by label of `segmentation`
  AutoOrientation orientation;                     ///< of the sheets' segments
  int k = 0;
  float spacing = 0.F;              ///< median
  float noise = 0.F;                ///< see NoiseLevel::fine
  bool denoised = false;            ///< whether positions were smoothed first
  bool consistent = false;          ///< see NoiseField
  float level = 0.F;                ///< see AutoNormals::level
  std::vector<ScaleEnergy> scales;  ///< see PipelineReport
  SheetTraits sheets;               ///< of the cloud, as measured or as told
  SheetTraits level_sheets;         ///< of the level's subset
  FinalTraits final_traits;
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
