// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/one_sided_fit.h"

#include <algorithm>
#include <cmath>

#include "features/symmetric_eigen.h"

namespace segorient::detail {
namespace {

// Secant of 30 degrees. A surface that turns farther away from its own points' plane on the way to
// the point looked at is an extrapolation that nothing supports.
constexpr double kSteepest = 1.1547;
// Fewer points than this get a plane.
constexpr std::size_t kFewestForQuadratic = 8;
// A curvature counts if each of its coefficients takes this many times a residual's share of the
// squares on average: noise alone does so once in some hundred times (F test). A plane's normal is
// far better determined at the border of its points, which is where the edge is.
constexpr double kLeastGain = 6.0;
constexpr double kSmallestPivot = 1e-4;

VectorN<6> termsAt(double x, double y) {
  return {1.0, x, y, x * x, x * y, y * y};
}

}  // namespace

bool OneSidedFit::findFrame(const NearPoint* points, std::size_t count) {
  double mean[3] = {0, 0, 0};
  double farthest = 0;
  for (std::size_t j = 0; j < count; ++j) {
    for (int a = 0; a < 3; ++a) mean[a] += points[j].offset[a];
    farthest = std::max(farthest, points[j].sqr_distance);
  }
  for (double& m : mean) m /= static_cast<double>(count);
  SymmetricMatrix3 c{};
  for (std::size_t j = 0; j < count; ++j) {
    const double d[3] = {points[j].offset[0] - mean[0], points[j].offset[1] - mean[1],
                         points[j].offset[2] - mean[2]};
    c.add(d);
  }
  const SymmetricEigen3 eigen = symmetricEigen(c);
  if (!(eigen.values[1] > 1e-6 * eigen.values[2]) || !(farthest > 0.0)) return false;
  reach_ = std::sqrt(farthest);
  for (int a = 0; a < 3; ++a) {
    origin_[a] = mean[a];
    axes_[0][a] = eigen.vectors[2][a];
    axes_[1][a] = eigen.vectors[1][a];
    axes_[2][a] = eigen.vectors[0][a];
  }
  return true;
}

std::array<double, 3> OneSidedFit::inFrame(const double* offset) const {
  const double scale = 1.0 / reach_;
  const double d[3] = {(offset[0] - origin_[0]) * scale, (offset[1] - origin_[1]) * scale,
                       (offset[2] - origin_[2]) * scale};
  std::array<double, 3> local{};
  for (std::size_t i = 0; i < 3; ++i) {
    local[i] = d[0] * axes_[i][0] + d[1] * axes_[i][1] + d[2] * axes_[i][2];
  }
  return local;
}

double OneSidedFit::sumUp(const NearPoint* points, std::size_t count, VectorN<6>& right) {
  double x1 = 0, y1 = 0, x2 = 0, xy = 0, y2 = 0, x3 = 0, x2y = 0, xy2 = 0, y3 = 0;
  double x4 = 0, x3y = 0, x2y2 = 0, xy3 = 0, y4 = 0, squares = 0;
  right = {};
  for (std::size_t j = 0; j < count; ++j) {
    const std::array<double, 3> p = inFrame(points[j].offset);
    const double xx = p[0] * p[0];
    const double cross = p[0] * p[1];
    const double yy = p[1] * p[1];
    x1 += p[0];
    y1 += p[1];
    x2 += xx;
    xy += cross;
    y2 += yy;
    x3 += xx * p[0];
    x2y += xx * p[1];
    xy2 += p[0] * yy;
    y3 += yy * p[1];
    x4 += xx * xx;
    x3y += xx * cross;
    x2y2 += xx * yy;
    xy3 += cross * yy;
    y4 += yy * yy;
    squares += p[2] * p[2];
    right[0] += p[2];
    right[1] += p[0] * p[2];
    right[2] += p[1] * p[2];
    right[3] += xx * p[2];
    right[4] += cross * p[2];
    right[5] += yy * p[2];
  }
  factor_ = {{{static_cast<double>(count)},
              {x1, x2},
              {y1, xy, y2},
              {x2, x3, x2y, x4},
              {xy, x2y, xy2, x3y, x2y2},
              {y2, xy2, y3, x2y2, xy3, y4}}};
  return squares;
}

void OneSidedFit::fit(const NearPoint* points, std::size_t count) {
  order_ = 0;
  if (count < 4 || !findFrame(points, count)) return;
  VectorN<6> right{};
  const double squares = sumUp(points, count, right);
  SquareMatrix<6>& m = factor_;
  const std::size_t determined = decompose(m, kSmallestPivot);
  if (determined < 3) return;
  // What each coefficient takes of the squares, given those before it.
  substituteForward(m, right, determined == 6 ? 6 : 3);
  const auto rest = [&](std::size_t order) {
    double left = squares;
    for (std::size_t i = 0; i < order; ++i) left -= right[i] * right[i] / m[i][i];
    const double freedom = std::max(1.0, static_cast<double>(count) - static_cast<double>(order));
    return std::max(0.0, left) / freedom;
  };
  order_ = 3;
  if (determined == 6 && count >= kFewestForQuadratic) {
    double gain = 0;
    for (std::size_t i = 3; i < 6; ++i) gain += right[i] * right[i] / m[i][i];
    if (gain > 3.0 * kLeastGain * rest(6)) order_ = 6;
  }
  rms_ = reach_ * std::sqrt(rest(order_));
  for (std::size_t i = 0; i < 3; ++i) plane_[i] = right[i] / m[i][i];
  substituteBackward(m, plane_);
  if (order_ < 6) return;
  for (std::size_t i = 0; i < 6; ++i) quadratic_[i] = right[i] / m[i][i];
  substituteBackward(m, quadratic_);
}

SurfaceView OneSidedFit::at(const double* offset) const {
  const std::array<double, 3> local = inFrame(offset);
  const double x = local[0];
  const double y = local[1];
  std::size_t order = order_;
  double z = plane_[0] + plane_[1] * x + plane_[2] * y;
  double slope[2] = {plane_[1], plane_[2]};
  if (order == 6) {
    const VectorN<6>& c = quadratic_;
    const double u = c[1] + 2.0 * c[3] * x + c[4] * y;
    const double v = c[2] + c[4] * x + 2.0 * c[5] * y;
    if (1.0 + u * u + v * v <= kSteepest * kSteepest) {
      z = c[0] + x * (c[1] + c[3] * x + c[4] * y) + y * (c[2] + c[5] * y);
      slope[0] = u;
      slope[1] = v;
    } else {
      order = 3;
    }
  }
  SurfaceView view;
  const double secant = std::sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1]);
  for (int a = 0; a < 3; ++a) {
    view.normal[a] = (axes_[2][a] - slope[0] * axes_[0][a] - slope[1] * axes_[1][a]) / secant;
  }
  view.height = reach_ * (z - local[2]) / secant;
  VectorN<6> terms = termsAt(x, y);
  substituteForward(factor_, terms, order);
  for (std::size_t i = 0; i < order; ++i) view.leverage += terms[i] * terms[i] / factor_[i][i];
  return view;
}

}  // namespace segorient::detail
