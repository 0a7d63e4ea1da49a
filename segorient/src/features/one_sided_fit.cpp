// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "one_sided_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cholesky.h"
#include "symmetric_eigen.h"

namespace segorient::detail {
namespace {

/// Secant of 30 degrees. A surface that turns farther away from its own points' plane on the way to
/// the point looked at is an extrapolation that nothing supports.
constexpr double kSteepest = 1.1547;

/// Points over their best plane; lengths in units of the largest distance from the point looked at.
struct Projection {
  double unit;
  double axes[3][3];  ///< x, y, z
  std::vector<std::array<double, 3>> local;
};

bool project(const NearPoint* points, std::size_t count, Projection& projection) {
  double mean[3] = {0, 0, 0};
  double farthest = 0;
  for (std::size_t j = 0; j < count; ++j) {
    for (int a = 0; a < 3; ++a) mean[a] += points[j].offset[a] / static_cast<double>(count);
    farthest = std::max(farthest, points[j].sqr_distance);
  }
  SymmetricMatrix3 c{};
  for (std::size_t j = 0; j < count; ++j) {
    const double d[3] = {points[j].offset[0] - mean[0], points[j].offset[1] - mean[1],
                         points[j].offset[2] - mean[2]};
    c.xx += d[0] * d[0];
    c.xy += d[0] * d[1];
    c.xz += d[0] * d[2];
    c.yy += d[1] * d[1];
    c.yz += d[1] * d[2];
    c.zz += d[2] * d[2];
  }
  const SymmetricEigen3 eigen = symmetricEigen(c);
  if (!(eigen.values[1] > 1e-6 * eigen.values[2]) || !(farthest > 0.0)) return false;
  projection.unit = std::sqrt(farthest);
  for (int a = 0; a < 3; ++a) {
    projection.axes[0][a] = eigen.vectors[2][a];
    projection.axes[1][a] = eigen.vectors[1][a];
    projection.axes[2][a] = eigen.vectors[0][a];
  }
  projection.local.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0;
      for (int a = 0; a < 3; ++a) sum += points[j].offset[a] * projection.axes[i][a];
      projection.local[j][i] = sum / projection.unit;
    }
  }
  return true;
}

template <std::size_t N>
VectorN<N> termsAt(double x, double y) {
  if constexpr (N == 6) {
    return {1.0, x, y, x * x, x * y, y * y};
  } else {
    return {1.0, x, y};
  }
}

template <std::size_t N>
bool fitPolynomial(const Projection& projection, OneSidedFit& fit) {
  const std::size_t count = projection.local.size();
  if (count < N) return false;
  SquareMatrix<N> m{};
  VectorN<N> c{};
  for (const auto& p : projection.local) {
    const VectorN<N> t = termsAt<N>(p[0], p[1]);
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k <= i; ++k) m[i][k] += t[i] * t[k];
      c[i] += t[i] * p[2];
    }
  }
  if (decompose(m) < 1e-4) return false;
  solveDecomposed(m, c);
  VectorN<N> constant{};
  constant[0] = 1.0;
  solveDecomposed(m, constant);
  double squares = 0;
  for (const auto& p : projection.local) {
    const VectorN<N> t = termsAt<N>(p[0], p[1]);
    double z = p[2];
    for (std::size_t i = 0; i < N; ++i) z -= t[i] * c[i];
    squares += z * z;
  }
  const double slope = std::sqrt(1.0 + c[1] * c[1] + c[2] * c[2]);
  if (N > 3 && slope > kSteepest) return false;
  for (int a = 0; a < 3; ++a) {
    fit.normal[a] =
        (projection.axes[2][a] - c[1] * projection.axes[0][a] - c[2] * projection.axes[1][a]) /
        slope;
  }
  const double freedom = std::max(1.0, static_cast<double>(count) - static_cast<double>(N));
  fit.height = projection.unit * c[0] / slope;
  fit.rms = projection.unit * std::sqrt(squares / freedom);
  fit.leverage = constant[0];
  fit.reach = projection.unit;
  fit.valid = true;
  return true;
}

}  // namespace

OneSidedFit fitOneSided(const NearPoint* points, std::size_t count) {
  OneSidedFit fit;
  Projection projection;
  if (count < 4 || !project(points, count, projection)) return fit;
  if (count < 8 || !fitPolynomial<6>(projection, fit)) fitPolynomial<3>(projection, fit);
  return fit;
}

}  // namespace segorient::detail
