// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/features/normal_3d.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/features/normal_options.h>

#include <vector>

namespace segorient {

/// What the normal estimators of this library have in common: everything that
/// pcl::NormalEstimationOMP offers, and a ready table of neighbours in place of a search.
///
/// As in PCL, setKSearch() counts the point itself, normals are turned towards the viewpoint, an
/// undefined normal is NaN (and its curvature) and clears is_dense, and an organised cloud keeps
/// its width and height. With no search method set, neighbours come from MedianHashIndex, among the
/// distinct finite points of the cloud. Unlike PCL's, neighbourhoods on a line have no normal.
/// Bad settings (no cloud, an empty one, k < 0, a radius that is not positive, both or neither) are
/// an error message and an empty output; an index out of range gives NaN. So does, where
/// neighbours are not given, a stray farther from the bulk of the points than 2^24 times its
/// extent.
template <typename PointInT, typename PointOutT>
class LocalNormalEstimation : public pcl::NormalEstimation<PointInT, PointOutT> {
 public:
  using Base = pcl::NormalEstimation<PointInT, PointOutT>;
  using Ptr = pcl::shared_ptr<LocalNormalEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const LocalNormalEstimation<PointInT, PointOutT>>;
  using NeighborhoodsConstPtr = pcl::shared_ptr<const Neighborhoods>;
  using PointCloudOut = typename Base::PointCloudOut;
  using PointCloudConstPtr = typename Base::PointCloudConstPtr;

  using Base::setInputCloud;
  void setInputCloud(const PointCloudConstPtr& cloud) override;

  /// \param threads 0 (default) = all cores. The result does not depend on it
  void setNumberOfThreads(unsigned int threads = 0) {
    options_.threads = static_cast<int>(threads);
  }
  unsigned int getNumberOfThreads() const { return static_cast<unsigned int>(options_.threads); }

  /// Uses this table instead of searching. Its rows belong to the points of the input cloud, if
  /// there are as many, and else to the indices of setIndices(); its entries to the search surface.
  /// setKSearch() then says how many entries of each row to use (0 = all); a radius is not looked
  /// at. Null (default): search.
  void setNeighborhoods(const NeighborhoodsConstPtr& neighborhoods) {
    neighborhoods_ = neighborhoods;
  }
  NeighborhoodsConstPtr getNeighborhoods() const { return neighborhoods_; }

 protected:
  LocalNormalEstimation(const char* name, NormalEstimator estimator, unsigned int threads);

  using Base::fake_surface_;
  using Base::feature_name_;
  using Base::getClassName;
  using Base::indices_;
  using Base::input_;
  using Base::k_;
  using Base::search_method_surface_;
  using Base::search_parameter_;
  using Base::search_radius_;
  using Base::surface_;
  using Base::tree_;

  bool initCompute() override;
  void computeFeature(PointCloudOut& output) override;

  LocalNormalOptions options_;
  bool keep_curvatures_ = false;
  std::vector<LocalCurvature> curvatures_;  ///< of the last compute(), if keep_curvatures_

 private:
  bool estimate(std::vector<float>& normals);
  void write(const std::vector<float>& normals, PointCloudOut& output);

  NeighborhoodsConstPtr neighborhoods_;

 public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace segorient

#ifdef PCL_NO_PRECOMPILE
#include <segorient/features/impl/local_normal_estimation.hpp>
#endif
