// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>

#include "features/cholesky.h"

namespace segorient::detail {

/// A point by its offset from the middle of a patch.
struct NearPoint {
  double offset[3];
  double sqr_distance;
};

/// A surface as seen from some point.
struct SurfaceView {
  double normal[3] = {0, 0, 1};  ///< unit, where the surface passes the point
  double height = 0.0;           ///< distance at which it passes
  double leverage = 0.0;         ///< variance of the height for residuals of variance 1
};

/// A surface z = f(x, y) through some of the points near the middle of a patch: a quadratic over
/// their best plane, or that plane where the points do not show a curvature.
class OneSidedFit {
 public:
  /// Needs four points; the nearer ones decide nothing more than the others.
  void fit(const NearPoint* points, std::size_t count);

  bool valid() const { return order_ > 0; }
  double rms() const { return rms_; }      ///< residual, corrected for the number of coefficients
  double reach() const { return reach_; }  ///< distance of the farthest point
  const double* center() const { return origin_; }  ///< mean of the points
  SurfaceView at(const double* offset) const;

 private:
  std::array<double, 3> inFrame(const double* offset) const;
  bool findFrame(const NearPoint* points, std::size_t count);
  /// Normal equations of the quadratic: the matrix into factor_. \return the sum of all z^2
  double sumUp(const NearPoint* points, std::size_t count, VectorN<6>& right);

  std::size_t order_ = 0;  ///< coefficients in use: 6, 3, or 0 for no surface
  double reach_ = 1.0;     ///< also the unit of length in the frame
  double rms_ = 0.0;
  double origin_[3] = {0, 0, 0};
  double axes_[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< x, y, z
  VectorN<6> quadratic_{};
  VectorN<3> plane_{};
  SquareMatrix<6> factor_{};  ///< of the normal equations; its upper left corner is the plane's
};

}  // namespace segorient::detail
