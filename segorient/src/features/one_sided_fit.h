// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <vector>

namespace segorient::detail {

/// A point near the one that is looked at.
struct NearPoint {
  double offset[3];
  double sqr_distance;
};

/// A surface through some of the points near a point, as seen from that point.
struct OneSidedFit {
  bool valid = false;
  double normal[3] = {0, 0, 1};  ///< unit, where the surface passes the point
  double height = 0.0;           ///< distance at which it passes
  double rms = 0.0;              ///< residual, corrected for the number of coefficients
  double leverage = 0.0;         ///< variance of the height for residuals of variance 1
  double reach = 0.0;            ///< distance of the farthest point
};

/// Fits a quadratic surface over the points' own best plane; a plane where they do not determine
/// more. Needs four points.
OneSidedFit fitOneSided(const NearPoint* points, std::size_t count);

}  // namespace segorient::detail
