// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Approximation with an analytic surface, cubic (paper, section 2.2). In double precision: the
// normal equations of ten coefficients lose more digits than float has. Included once per
// instruction set.

/// As many doubles as fill a register, for half of its points.
using Doubles = SEGORIENT_VECTOR(double, SEGORIENT_LANES / 2);
using DoublesMask = SEGORIENT_VECTOR(std::int64_t, SEGORIENT_LANES / 2);
constexpr std::size_t kDoubles = kWidth / 2;
using Doubles3 = Vector3<Doubles>;

inline Doubles widened(const float* p) {
  using Part = SEGORIENT_VECTOR(float, SEGORIENT_LANES / 2);
  Part part;
  copyBytes(&part, p, sizeof(part));
  return SEGORIENT_CONVERTED(part, Doubles);
}
inline Doubles widened(const Lanes& a, std::size_t part) {
  float values[kWidth];
  store(values, a);
  return widened(values + part * kDoubles);
}
inline Doubles3 widened(const Lanes3& a, std::size_t part) {
  return {widened(a.x, part), widened(a.y, part), widened(a.z, part)};
}

/// Cubic surfaces over frames; lengths in units of plane.size.
struct Cubics {
  double c[10][kWidth];    ///< of 1, x, y, x^2, x y, y^2, x^3, x^2 y, x y^2, y^3
  double squares[kWidth];  ///< sum of the squares that they leave
  bool valid[kWidth];
};

/// The surfaces of half of a register's points.
SEGORIENT_APART void fitCubicPart(const Batch& batch, std::size_t half, std::size_t part,
                                  const Plane& plane, const Frame<Lanes>& frame, Cubics& result) {
  const Doubles zero{};
  const Doubles unit_length = 1.0 / widened(plane.size, part);
  const Doubles3 u = scaled(widened(frame.u, part), unit_length);
  const Doubles3 v = scaled(widened(frame.v, part), unit_length);
  const Doubles3 w = scaled(widened(frame.n, part), unit_length);
  // Sums of x^(d-i) y^i, by degree d and i.
  Doubles sums[7][7];
  for (auto& degree : sums) {
    for (Doubles& s : degree) s = zero;
  }
  Doubles x[10];
  for (Doubles& s : x) s = zero;
  Doubles squares = zero;
  for (int j = batch.first; j < batch.count; ++j) {
    const std::size_t at =
        static_cast<std::size_t>(j) * kBatchRows + half * kWidth + part * kDoubles;
    const Doubles3 d{widened(batch.x + at), widened(batch.y + at), widened(batch.z + at)};
    const Doubles height = dot(d, w);
    squares += height * height;
    Doubles terms[7][7];
    terms[1][0] = dot(d, u);
    terms[1][1] = dot(d, v);
    x[0] += height;
    int coefficient = 1;
    SEGORIENT_UNROLL
    for (int degree = 1; degree < 7; ++degree) {
      SEGORIENT_UNROLL
      for (int i = 0; i <= degree; ++i) {
        if (degree > 1) {
          terms[degree][i] = i < degree ? terms[degree - 1][i] * terms[1][0]
                                        : terms[degree - 1][i - 1] * terms[1][1];
        }
        sums[degree][i] += terms[degree][i];
        if (degree <= 3) x[coefficient++] += terms[degree][i] * height;
      }
    }
  }
  const Doubles count = widened(batch.countsOf(half), part);
  sums[0][0] = count;
  constexpr int kDegree[10] = {0, 1, 1, 2, 2, 2, 3, 3, 3, 3};
  constexpr int kPower[10] = {0, 0, 1, 0, 1, 2, 0, 1, 2, 3};  // of y
  Doubles m[10][10];
  Doubles right[10];
  for (int i = 0; i < 10; ++i) {
    right[i] = x[i];
    for (int k = 0; k <= i; ++k) m[i][k] = sums[kDegree[i] + kDegree[k]][kPower[i] + kPower[k]];
  }
  const DoublesMask valid = solveSymmetric<DoublesMask>(m, x, 1e-6) & (count >= 10.0);
  for (int i = 0; i < 10; ++i) squares -= right[i] * x[i];
  for (std::size_t l = 0; l < kDoubles; ++l) {
    const std::size_t lane = part * kDoubles + l;
    for (int i = 0; i < 10; ++i) result.c[i][lane] = x[i][l];
    result.squares[lane] = squares[l];
    result.valid[lane] = valid[l] != 0;
  }
}

inline void fitCubics(const Batch& batch, std::size_t half, const Plane& plane,
                      const Frame<Lanes>& frame, Cubics& result) {
  for (std::size_t part = 0; part < 2; ++part) {
    fitCubicPart(batch, half, part, plane, frame, result);
  }
}
