// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/features/local_normal_estimation.h>

namespace segorient {

/// Normals by local Delaunay triangulation: the mean of the unit normals of the triangles around
/// the point (paper, section 2.2). The sharpest at edges of clean clouds, and the first to suffer
/// from noise. Use as PlaneNormalEstimation.
template <typename PointInT, typename PointOutT>
class LDTNormalEstimation : public LocalNormalEstimation<PointInT, PointOutT> {
 public:
  using Ptr = pcl::shared_ptr<LDTNormalEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const LDTNormalEstimation<PointInT, PointOutT>>;

  /// \param threads as setNumberOfThreads()
  explicit LDTNormalEstimation(unsigned int threads = 0)
      : LocalNormalEstimation<PointInT, PointOutT>("LDTNormalEstimation", NormalEstimator::LDT,
                                                   threads) {}
};

}  // namespace segorient
