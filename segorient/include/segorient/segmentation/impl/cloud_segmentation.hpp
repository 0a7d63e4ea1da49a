// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>
#include <segorient/common/impl/point_search.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace segorient {

class PreparedCloud;

/// Segmentation of a cloud as it comes: with NaN points, duplicates, indices. The part of
/// NormalSegmentation that does not depend on the point type.
class SEGORIENT_SEGMENTATION_EXPORT CloudSegmentation {
 public:
  /// k nearest of one of the cloud's points, as indices into the cloud, itself included.
  using Search = PointSearch;

  struct Input {
    PointView points;    ///< the whole cloud
    NormalView normals;  ///< of the whole cloud; both are needed until compute() returns
    const pcl::Indices* indices =
        nullptr;                           ///< points to segment, null = all; bad ones are left out
    const Neighborhoods* table = nullptr;  ///< of the whole cloud, or null to search; outlives this
    Search search;                         ///< empty = search::MedianHashIndex
    int neighbors = 10;                    ///< neighbours of each point, itself not counted
    bool unite_smooth = false;             ///< whether faces() differ from segmentation()
  };

  /// \return false if sizes do not agree or the table is not of this cloud; the result is empty
  /// then
  bool compute(const Input& input, const SegmentationOptions& options);
  void clear();

  /// Of the whole cloud: points that were not to be segmented have label -1. Exact duplicates share
  /// their label.
  const Segmentation& segmentation() const { return result_; }
  /// With `unite_smooth` the segments united over smooth borders; else the segments as they are.
  const Segmentation& faces() const { return united_ ? faces_ : result_; }
  /// By point: share of its neighbours that are in the same face; 0 without one.
  std::vector<float> confidences() const;
  const SegmentationReport& report() const { return report_; }
  /// Pairs are indices into the cloud; of duplicates only the first is in a pair.
  SegmentGraph graph() const;

 private:
  bool computeWithTable(const Input& input, const SegmentationOptions& options);
  void computePrepared(const Input& input, const SegmentationOptions& options);
  const Neighborhoods& table() const;
  std::size_t rowOf(pcl::index_t point) const;

  Segmentation result_;
  Segmentation faces_;
  bool united_ = false;
  SegmentationReport report_;
  const Neighborhoods* table_ = nullptr;  ///< the user's
  std::shared_ptr<PreparedCloud> cloud_;  ///< otherwise
  int neighbors_ = 0;
};

}  // namespace segorient
