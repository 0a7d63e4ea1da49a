// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/slope_gain.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "features/cholesky.h"

namespace segorient::detail {
namespace {

constexpr std::size_t kOrder = 6;  // of 1, x, y, x^2, x y, y^2
using Terms = VectorN<kOrder>;

// What rounding leaves of a pivot.
constexpr double kLeastPivot = 1e-12;

// Variances of the slopes along both axes, for unit noise.
double slopeVariance(SquareMatrix<kOrder>& squares) {
  if (decompose(squares, kLeastPivot) < kOrder) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const std::size_t axis : {1U, 2U}) {
    Terms x{};
    x[axis] = 1.0;
    substituteForward(squares, x, kOrder);
    for (std::size_t i = 0; i < kOrder; ++i) sum += x[i] * x[i] / squares[i][i];
  }
  return sum;
}

}  // namespace

bool tellsSlope(const Surroundings& of, std::size_t row, int k, const float* normal, double most) {
  if (!isFinite(normal)) return false;
  const int count = std::min(of.table.count(row), k + 1);
  const Eigen::Vector3d n(normal[0], normal[1], normal[2]);
  const Eigen::Vector3d u = n.unitOrthogonal();
  const Eigen::Vector3d v = n.cross(u);
  const auto offset = [&](int j) {
    const float* p = of.points[static_cast<std::size_t>(of.table.indices(row)[j])];
    const float* o = of.at[row];
    return Eigen::Vector3d(static_cast<double>(p[0]) - static_cast<double>(o[0]),
                           static_cast<double>(p[1]) - static_cast<double>(o[1]),
                           static_cast<double>(p[2]) - static_cast<double>(o[2]));
  };
  double square = 0.0;
  for (int j = 0; j < count; ++j) square += offset(j).squaredNorm();
  if (!(square > 0.0)) return false;
  // The mean square distance is 1 then, and the plane's slopes have a variance of 4 over count.
  const double unit = std::sqrt(square / count);
  SquareMatrix<kOrder> squares{};
  for (int j = 0; j < count; ++j) {
    const Eigen::Vector3d d = offset(j) / unit;
    const double x = d.dot(u);
    const double y = d.dot(v);
    const Terms terms{1.0, x, y, x * x, x * y, y * y};
    for (std::size_t a = 0; a < kOrder; ++a) {
      for (std::size_t b = 0; b <= a; ++b) squares[a][b] += terms[a] * terms[b];
    }
  }
  return slopeVariance(squares) * count <= 4.0 * most * most;
}

}  // namespace segorient::detail
