// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/symmetric_eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace segorient::detail {
namespace {

/// Annihilates a[p][q] by a rotation, which is also applied to the columns of v (Golub and Van
/// Loan, Matrix Computations, section 8.5).
void rotate(double a[3][3], double v[3][3], int p, int q) {
  if (a[p][q] == 0.0) return;
  const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0);
  const double s = t * c;
  const int r = 3 - p - q;
  const double apq = a[p][q];
  const double arp = a[r][p];
  const double arq = a[r][q];
  a[p][p] -= t * apq;
  a[q][q] += t * apq;
  a[p][q] = a[q][p] = 0.0;
  a[r][p] = a[p][r] = c * arp - s * arq;
  a[r][q] = a[q][r] = s * arp + c * arq;
  for (int i = 0; i < 3; ++i) {
    const double vip = v[i][p];
    const double viq = v[i][q];
    v[i][p] = c * vip - s * viq;
    v[i][q] = s * vip + c * viq;
  }
}

}  // namespace

SymmetricEigen3 symmetricEigen(const SymmetricMatrix3& m) {
  SymmetricEigen3 result{};
  // Entries near 1, so that no square over- or underflows.
  const double scale = std::max({std::abs(m.xx), std::abs(m.yy), std::abs(m.zz), std::abs(m.xy),
                                 std::abs(m.xz), std::abs(m.yz)});
  const bool finite = std::isfinite(m.xx + m.yy + m.zz + m.xy + m.xz + m.yz);
  const double unit = finite && scale > 0.0 ? 1.0 / scale : 1.0;
  double a[3][3] = {{m.xx * unit, m.xy * unit, m.xz * unit},
                    {m.xy * unit, m.yy * unit, m.yz * unit},
                    {m.xz * unit, m.yz * unit, m.zz * unit}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  // Convergence is quadratic: four or five sweeps reach the last bit. What is left then changes the
  // eigenvalues by its square.
  for (int sweep = 0; finite && sweep < 16; ++sweep) {
    const double off = std::abs(a[0][1]) + std::abs(a[0][2]) + std::abs(a[1][2]);
    if (off < 1e-20) break;
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  int order[3] = {0, 1, 2};
  if (finite) std::sort(order, order + 3, [&](int i, int j) { return a[i][i] < a[j][j]; });
  for (int i = 0; i < 3; ++i) {
    result.values[i] =
        finite ? a[order[i]][order[i]] / unit : std::numeric_limits<double>::quiet_NaN();
    for (int j = 0; j < 3; ++j) result.vectors[i][j] = v[j][order[i]];
  }
  const double(&e)[3][3] = result.vectors;
  const double det = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                     e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                     e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  if (det < 0.0) {
    for (double& x : result.vectors[2]) x = -x;
  }
  return result;
}

}  // namespace segorient::detail
