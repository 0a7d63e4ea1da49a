// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Approximation with an analytic surface, quadratic (paper, section 2.2). Included once per
// instruction set.

/// Solves symmetric positive definite systems whose lower triangles are in m, by Cholesky
/// decomposition without roots; x holds the right sides and then the solutions. \return where no
/// pivot fell below a share of its diagonal
template <typename M, typename V, typename Share, int kOrder>
inline M solveSymmetric(V (&m)[kOrder][kOrder], V (&x)[kOrder], Share least_pivot) {
  M regular = M{} == 0;
  V inverse[kOrder];
  SEGORIENT_UNROLL
  for (int j = 0; j < kOrder; ++j) {
    const V diagonal = m[j][j];
    V scaled_row[kOrder];
    SEGORIENT_UNROLL
    for (int k = 0; k < j; ++k) {
      scaled_row[k] = m[j][k];         // L times D so far
      m[j][k] = m[j][k] * inverse[k];  // L
      m[j][j] -= scaled_row[k] * m[j][k];
    }
    regular &= m[j][j] > least_pivot * diagonal;
    inverse[j] = Share(1) / m[j][j];
    SEGORIENT_UNROLL
    for (int i = j + 1; i < kOrder; ++i) {
      SEGORIENT_UNROLL
      for (int k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
    }
  }
  SEGORIENT_UNROLL
  for (int i = 0; i < kOrder; ++i) {
    SEGORIENT_UNROLL
    for (int k = 0; k < i; ++k) x[i] -= m[i][k] * x[k];
  }
  SEGORIENT_UNROLL
  for (int i = 0; i < kOrder; ++i) x[i] *= inverse[i];
  SEGORIENT_UNROLL
  for (int i = kOrder - 1; i >= 0; --i) {
    SEGORIENT_UNROLL
    for (int k = i + 1; k < kOrder; ++k) x[i] -= m[k][i] * x[k];
  }
  return regular;
}

/// Quadratic surfaces over frames; lengths in units of plane.size.
struct Quadratic {
  Lanes c[6];      ///< of 1, x, y, x^2, x y, y^2
  Lanes residual;  ///< standard deviation of the points from the surface
  Mask valid;
};

inline Quadratic fitQuadratics(const Batch& batch, std::size_t half, const Plane& plane,
                               const Frame<Lanes>& frame) {
  const Lanes zero{};
  const Lanes unit_length = 1.0F / plane.size;
  const Frame<Lanes> scaled_frame{scaled(frame.u, unit_length), scaled(frame.v, unit_length),
                                  scaled(frame.n, unit_length)};
  Lanes x1 = zero, y1 = zero, x2 = zero, xy = zero, y2 = zero, x3 = zero, x2y = zero, xy2 = zero,
        y3 = zero, x4 = zero, x3y = zero, x2y2 = zero, xy3 = zero, y4 = zero;
  Lanes z2 = zero;
  Quadratic q;
  for (Lanes& c : q.c) c = zero;
  for (int j = batch.first; j < batch.count; ++j) {
    const Lanes3 d = batch.offset(j, half);
    const Lanes x = dot(d, scaled_frame.u);
    const Lanes y = dot(d, scaled_frame.v);
    const Lanes z = dot(d, scaled_frame.n);
    const Lanes xx = x * x;
    const Lanes xy_ = x * y;
    const Lanes yy = y * y;
    x1 += x;
    y1 += y;
    x2 += xx;
    xy += xy_;
    y2 += yy;
    x3 += xx * x;
    x2y += xx * y;
    xy2 += x * yy;
    y3 += yy * y;
    x4 += xx * xx;
    x3y += xx * xy_;
    x2y2 += xx * yy;
    xy3 += xy_ * yy;
    y4 += yy * yy;
    z2 += z * z;
    q.c[0] += z;
    q.c[1] += x * z;
    q.c[2] += y * z;
    q.c[3] += xx * z;
    q.c[4] += xy_ * z;
    q.c[5] += yy * z;
  }
  const Lanes count = batch.countsOf(half);
  Lanes m[6][6] = {{count},
                   {x1, x2},
                   {y1, xy, y2},
                   {x2, x3, x2y, x4},
                   {xy, x2y, xy2, x3y, x2y2},
                   {y2, xy2, y3, x2y2, xy3, y4}};
  Lanes right[6];
  for (int i = 0; i < 6; ++i) right[i] = q.c[i];
  // Below such pivots float would not carry it.
  q.valid = plane.valid & solveSymmetric<Mask>(m, q.c, 1e-4F);
  // The squares that are left, by the normal equations; for each point more than coefficients.
  for (int i = 0; i < 6; ++i) z2 -= right[i] * q.c[i];
  q.residual = squareRoot(larger(zero, z2) / larger(count - 6.0F, all(1.0F)));
  return q;
}
