// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/compact_cloud.h>
#include <segorient/orientation/auto_orientation.h>
#include <segorient/orientation/pipeline.h>

#include <functional>
#include <vector>

namespace segorient::detail {

/// What the default method found out about the distinct points of a cloud.
struct AutoStages {
  std::vector<float> normals;      ///< 4 floats a point: oriented normal, curvature; NaN where none
  std::vector<float> confidences;  ///< of the orientation, 0 to 1
  std::vector<std::int32_t> components;  ///< -1 where there is no normal
  Segmentation segmentation;  ///< by the final normals, reference normals and signs oriented
  std::vector<SegmentOrientationResult> segments;  ///< by label of `segmentation`
  AutoOrientation orientation;                     ///< of the sheets' segments
  int k = 0;
  float spacing = 0.F;    ///< median
  float noise = 0.F;      ///< see NoiseLevel::fine
  bool denoised = false;  ///< whether positions were smoothed first
};

/// Oriented normals of points whose neighbours are known.
struct AutoNormals {
  std::vector<float> normals;            ///< 4 floats a point: oriented normal, residual
  std::vector<float> confidences;        ///< of the orientation, 0 to 1
  std::vector<std::int32_t> components;  ///< -1 where there is no normal
  AutoOrientation orientation;           ///< of the sheets' segments
  float spacing = 0.F;                   ///< median
};

/// Sheet normals, sheet segments, their orientation, and the filter that makes the final normals.
/// \param begin may be empty, see runAutoStages()
AutoNormals orientPoints(const PointView& points, const Neighborhoods& neighborhoods,
                         const PipelineOptions& options, const PointHints& hints,
                         const std::function<void(const char*, double)>& begin = {});

/// The default method, from distinct points to oriented normals and segments: neighbours, sheet
/// normals, sheet segments, their orientation, the filter that makes the final normals, and the
/// paper's segmentation of those. \param begin called with a stage's name and the fraction of the
/// work done before it
AutoStages runAutoStages(const CompactCloud& cloud, const PipelineOptions& options,
                         const PointHints& hints,
                         const std::function<void(const char*, double)>& begin);

}  // namespace segorient::detail
