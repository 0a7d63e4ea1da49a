// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <string>
#include <vector>

#include "orientation/stage_clock.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// The paper's stages before orientation (section 2) on the points of a prepared cloud, each from
/// what the one before it found.
struct SurfaceStages {
  NormalView normalView() const { return {normals.data(), 4, cloud.size()}; }

  /// Neighbours (2.1). \param wanted as many, or as there are
  void findNeighbors(int wanted) { k = cloud.findNeighbors(wanted); }
  /// Unoriented normals (2.2) by `options.normals`. Automatic ones have the neighbours that were
  /// found and, unless the options say how many, more of them where the noise asks for more, and
  /// where points were seen by a sensor that the cloud itself tells of.
  void findNormals(const PipelineOptions& options);
  /// Segments (2.3), or faces where the options unite them.
  void findSegments(const SegmentationOptions& options);
  /// Normals near sharp edges from one side only (2.3.1), `options.recomputations` times, each time
  /// by the segments of `options.segmentation` that the normals then make.
  void recomputeNormals(const PipelineOptions& options, StageClock& clock);

  PreparedCloud cloud;
  int k = 0;  ///< neighbours of a point, itself not counted
  std::vector<float> normals;
  std::string normals_chosen;  ///< how normals were found and, where nothing was asked for, why so
  Segmentation segmentation;

 private:
  void findNormalsAutomatically(const PipelineOptions& options);
};

}  // namespace segorient::detail
