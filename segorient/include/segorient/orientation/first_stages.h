// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/compact_cloud.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <string>
#include <vector>

namespace segorient {

/// The stages before orientation one by one, on a cloud as it comes: for those who end with normals
/// or segments. Works on the distinct finite points, whose neighbours are found once, and gives
/// results by input row.
class FirstStages {
 public:
  /// Neighbours of a point where PipelineOptions::k leaves the choice open.
  static constexpr int kDefaultNeighbors = 12;

  /// Finds the neighbours. \param options must outlive this object; its `orientation` and what
  /// belongs to OrientationMethod::AUTO are not used \param progress may be empty
  FirstStages(const PointView& points, const PipelineOptions& options,
              PipelineProgress progress = {});

  /// Unoriented ones, by `options.normals`; those near sharp edges anew, `options.recomputations`
  /// times.
  void findNormals();
  /// After findNormals(). \param split whether faces that bend by more than beta stay in pieces, as
  /// the paper has it; otherwise these are united
  void findSegments(bool split);

  // By input row. Rows that repeat a point have that point's result.
  std::vector<float> normals() const;  ///< 4 floats: normal, curvature; NaN where there is none
  /// The same with the signs that agree within each segment.
  std::vector<float> normalsBySegment() const;
  Segmentation segmentation() const;  ///< sizes are in distinct points; members are not set

  const std::vector<StageTime>& times() const { return times_; }
  int k() const { return k_; }  ///< neighbours used, the point itself not counted
  /// How the normals were found, and why so: see PipelineReport::normals_chosen.
  const std::string& normalsChosen() const { return normals_chosen_; }
  std::size_t nonFinite() const;
  std::size_t duplicates() const;

 private:
  class Timer;

  void segment(double done, Segmentation* faces);
  void recomputeNormals();

  const PipelineOptions& options_;
  PipelineProgress progress_;
  std::vector<StageTime> times_;
  CompactCloud cloud_;
  search::MedianHashIndex index_;
  Neighborhoods neighborhoods_;
  std::vector<float> normals_;
  Segmentation segmentation_;
  std::string normals_chosen_;
  int k_ = 0;
};

}  // namespace segorient
