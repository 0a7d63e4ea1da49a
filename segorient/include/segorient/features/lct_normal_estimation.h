// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/features/local_normal_estimation.h>

namespace segorient {

/// Normals by local centre triangulation: the neighbours in angular order around their centre of
/// mass, each triangle of the fan weighted by its area (paper, section 2.2). The point itself does
/// not count as a neighbour. Use as PlaneNormalEstimation.
template <typename PointInT, typename PointOutT>
class LCTNormalEstimation : public LocalNormalEstimation<PointInT, PointOutT> {
 public:
  using Ptr = pcl::shared_ptr<LCTNormalEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const LCTNormalEstimation<PointInT, PointOutT>>;

  /// \param threads as setNumberOfThreads()
  explicit LCTNormalEstimation(unsigned int threads = 0)
      : LocalNormalEstimation<PointInT, PointOutT>("LCTNormalEstimation", NormalEstimator::LCT,
                                                   threads) {}
};

}  // namespace segorient
