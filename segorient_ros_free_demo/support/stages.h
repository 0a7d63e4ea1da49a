// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/compact_cloud.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/orientation/pipeline.h>

#include <chrono>
#include <string>
#include <vector>

#include "support/progress_bar.h"

namespace segorient::program {

/// The first stages one by one, for the commands that end before orientation: works on the distinct
/// finite points and gives results by input row.
class Stages {
 public:
  Stages(const PointView& points, const PipelineOptions& options, bool progress);

  void findNormals();   ///< searches neighbours, estimates a normal a point
  void findSegments();  ///< after findNormals()
  /// After findSegments(): normals near sharp edges, from one side only. Labels stay as they are.
  /// \param delta radians; 0 = one-sided surfaces, else the paper's rule with this angle
  void recomputeNormals(int rounds, float delta);

  std::vector<float> normals() const;  ///< 4 floats an input row, NaN where there is none
  Segmentation segmentation() const;   ///< labels and signs by input row; members are not set
  const std::vector<StageTime>& times() const { return times_; }
  int k() const { return k_; }
  std::size_t nonFinite() const;
  std::size_t duplicates() const;

  // By distinct point.
  const CompactCloud& cloud() const { return cloud_; }
  PointView compactNormals() const { return {normals_.data(), 4, cloud_.size()}; }
  const Neighborhoods& neighborhoods() const { return neighborhoods_; }
  const Segmentation& compactSegmentation() const { return segmentation_; }

 private:
  class Timer;

  const PipelineOptions& options_;
  ProgressBar bar_;
  std::vector<StageTime> times_;
  CompactCloud cloud_;
  Neighborhoods neighborhoods_;
  std::vector<float> normals_;
  Segmentation segmentation_;
  int k_ = 0;
};

/// "search 0.12  normals 0.03": one line of a summary.
std::string timesText(const std::vector<StageTime>& times);

}  // namespace segorient::program
