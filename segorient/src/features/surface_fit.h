// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "features/local_normals.h"

namespace segorient::detail {

/// A surface z = f(x, y) over a frame at a point, of which only what the point sees is kept: the
/// coefficients of 1, x, y, x^2, x y, y^2, with lengths in units of `size`.
struct SurfaceFit {
  bool valid = false;
  double size = 1.0;
  double c[6] = {0, 0, 0, 0, 0, 0};
  double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< x, y, z of the frame

  /// Curvatures at (0, 0), NaN where the fit is not valid.
  LocalCurvature curvature() const;
};

}  // namespace segorient::detail
