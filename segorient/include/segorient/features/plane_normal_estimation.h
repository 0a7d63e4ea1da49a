// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/features/local_normal_estimation.h>

namespace segorient {

/// Normals of least-squares planes: the same as those of pcl::NormalEstimationOMP, several times
/// faster (paper, section 2.2).
///
/// @code
/// segorient::PlaneNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
/// estimation.setInputCloud(cloud);
/// estimation.setKSearch(11);  // ten neighbours and the point itself
/// estimation.compute(*normals);
/// @endcode
template <typename PointInT, typename PointOutT>
class PlaneNormalEstimation : public LocalNormalEstimation<PointInT, PointOutT> {
 public:
  using Ptr = pcl::shared_ptr<PlaneNormalEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const PlaneNormalEstimation<PointInT, PointOutT>>;

  /// \param threads as setNumberOfThreads()
  explicit PlaneNormalEstimation(unsigned int threads = 0)
      : LocalNormalEstimation<PointInT, PointOutT>("PlaneNormalEstimation", NormalEstimator::PLANE,
                                                   threads) {}
};

}  // namespace segorient
