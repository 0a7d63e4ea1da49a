// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <segorient/features/local_normal_estimation.h>

namespace segorient {

/// Normals by approximation with an analytic surface z = f(x, y), quadratic or cubic, over the
/// tangent plane of a first guess (paper, section 2.2): an order more accurate than planes where
/// the surface is smooth. Where a neighbourhood does not determine the cubic surface the quadratic
/// one is used, and where not even that, the first guess. Use as PlaneNormalEstimation.
template <typename PointInT, typename PointOutT>
class AwASNormalEstimation : public LocalNormalEstimation<PointInT, PointOutT> {
 public:
  using Ptr = pcl::shared_ptr<AwASNormalEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const AwASNormalEstimation<PointInT, PointOutT>>;

  /// \param threads as setNumberOfThreads()
  explicit AwASNormalEstimation(unsigned int threads = 0)
      : LocalNormalEstimation<PointInT, PointOutT>("AwASNormalEstimation",
                                                   NormalEstimator::AWAS_QUADRATIC, threads) {}

  /// \param degree 2 (default) or 3; others are taken as the nearer of the two
  void setDegree(int degree) {
    this->options_.estimator =
        degree > 2 ? NormalEstimator::AWAS_CUBIC : NormalEstimator::AWAS_QUADRATIC;
  }
  int getDegree() const { return this->options_.estimator == NormalEstimator::AWAS_CUBIC ? 3 : 2; }

  /// \param estimator Plane (default), LCT or LDT; others mean Plane
  void setFirstGuess(NormalEstimator estimator) { this->options_.first_guess = estimator; }
  NormalEstimator getFirstGuess() const { return this->options_.first_guess; }

  /// Whether compute() keeps the surfaces' curvatures. Default false.
  void setComputePrincipalCurvatures(bool keep) { this->keep_curvatures_ = keep; }
  bool getComputePrincipalCurvatures() const { return this->keep_curvatures_; }

  /// Curvatures of the surfaces of the last compute(), one a normal, in 1 / unit of length:
  /// positive where the surface bends towards the normal. Unlike
  /// pcl::PrincipalCurvaturesEstimation's they are signed, with |pc1| >= |pc2|. NaN where there is
  /// no surface.
  void getPrincipalCurvatures(pcl::PointCloud<pcl::PrincipalCurvatures>& out) const {
    out.resize(this->curvatures_.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      const LocalCurvature& c = this->curvatures_[i];
      for (int a = 0; a < 3; ++a) out[i].principal_curvature[a] = c.direction[a];
      out[i].pc1 = c.pc1;
      out[i].pc2 = c.pc2;
    }
  }
};

}  // namespace segorient
