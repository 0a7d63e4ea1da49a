// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/surface_fit.h"

#include <cmath>
#include <limits>

namespace segorient::detail {

LocalCurvature SurfaceFit::curvature() const {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  if (!valid) return {{kNaN, kNaN, kNaN}, kNaN, kNaN};
  // Second fundamental form in an orthonormal tangent basis: along the gradient, where the surface
  // stretches lengths by w, and across it.
  const double gradient = std::hypot(c[1], c[2]);
  const double w = std::hypot(1.0, gradient);
  const double a[2] = {gradient > 0.0 ? c[1] / gradient : 1.0,
                       gradient > 0.0 ? c[2] / gradient : 0.0};
  const double b[2] = {-a[1], a[0]};
  const auto second = [&](const double* s, const double* t) {
    return (2.0 * c[3] * s[0] * t[0] + c[4] * (s[0] * t[1] + s[1] * t[0]) +
            2.0 * c[5] * s[1] * t[1]) /
           (w * size);
  };
  const double along = second(a, a) / (w * w);
  const double mixed = second(a, b) / w;
  const double across = second(b, b);
  const double mean = 0.5 * (along + across);
  const double half = std::hypot(0.5 * (along - across), mixed);
  const double larger = mean < 0.0 ? mean - half : mean + half;
  const double smaller = mean < 0.0 ? mean + half : mean - half;
  // Eigenvector of the larger one, from the better of the two rows.
  double s = mixed;
  double t = larger - along;
  if (std::abs(larger - across) > std::abs(larger - along)) {
    s = larger - across;
    t = mixed;
  }
  const double norm = std::hypot(s, t);
  s = norm > 0.0 ? s / norm : 1.0;
  t = norm > 0.0 ? t / norm : 0.0;
  LocalCurvature result{};
  for (int i = 0; i < 3; ++i) {
    const double tangent = (a[0] * axes[0][i] + a[1] * axes[1][i] + gradient * axes[2][i]) / w;
    const double level = b[0] * axes[0][i] + b[1] * axes[1][i];
    result.direction[i] = static_cast<float>(s * tangent + t * level);
  }
  result.pc1 = static_cast<float>(larger);
  result.pc2 = static_cast<float>(smaller);
  return result;
}

}  // namespace segorient::detail
