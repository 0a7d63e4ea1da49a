// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace segorient {

/// The stages before orientation one by one, on a cloud as it comes: for those who end with normals
/// or segments. Works on the distinct finite points, whose neighbours are found once, and gives
/// results by input row.
class SEGORIENT_ORIENTATION_EXPORT FirstStages {
 public:
  /// Neighbours of a point where PipelineOptions::k leaves the choice open.
  static constexpr int kDefaultNeighbors = 12;

  /// Finds the neighbours.
  /// \param options must outlive this object. Of its `orientation`, normals that are chosen
  ///        (NormalEstimator::AUTO and k = 0) heed `automatic.find_sensors` and what `hints`
  ///        suggest, nothing else is used
  /// \param progress may be empty
  FirstStages(const PointView& points, const PipelineOptions& options,
              PipelineProgress progress = {});
  ~FirstStages();
  FirstStages(const FirstStages&) = delete;
  FirstStages& operator=(const FirstStages&) = delete;

  /// Unoriented ones, by `options.normals`; those near sharp edges anew, `options.recomputations`
  /// times.
  void findNormals();
  /// By `options.segmentation`, after findNormals(), which is called if it was not.
  void findSegments();

  // By input row. Rows that repeat a point have that point's result.
  std::vector<float> normals() const;  ///< 4 floats: normal, curvature; NaN where there is none
  Segmentation segmentation() const;   ///< sizes are in rows

  const std::vector<StageTime>& times() const;
  int k() const;  ///< neighbours used, the point itself not counted
  /// How the normals were found, and why so: see PipelineReport::normals_chosen.
  const std::string& normalsChosen() const;
  std::size_t nonFinite() const;
  std::size_t duplicates() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace segorient
