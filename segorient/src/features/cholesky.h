// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>

namespace segorient::detail {

template <std::size_t N>
using SquareMatrix = std::array<std::array<double, N>, N>;
template <std::size_t N>
using VectorN = std::array<double, N>;

/// Decomposes the symmetric positive definite lower triangle of m into L D L^T, in place.
/// \return the smallest pivot as a share of its diagonal: 0 for a matrix that is not positive
/// definite
template <std::size_t N>
double decompose(SquareMatrix<N>& m) {
  double smallest = 1.0;
  for (std::size_t j = 0; j < N; ++j) {
    const double diagonal = m[j][j];
    for (std::size_t k = 0; k < j; ++k) {
      const double product = m[j][k];  // L times D so far
      m[j][k] = product / m[k][k];
      m[j][j] -= product * m[j][k];
    }
    const double share = m[j][j] / diagonal;
    if (!(share > 0.0)) return 0.0;
    if (share < smallest) smallest = share;
    for (std::size_t i = j + 1; i < N; ++i) {
      for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
    }
  }
  return smallest;
}

/// Replaces x by the solution for the right side x.
template <std::size_t N>
void solveDecomposed(const SquareMatrix<N>& m, VectorN<N>& x) {
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= m[i][k] * x[k];
  }
  for (std::size_t i = 0; i < N; ++i) x[i] /= m[i][i];
  for (std::size_t i = N; i-- > 0;) {
    for (std::size_t k = i + 1; k < N; ++k) x[i] -= m[k][i] * x[k];
  }
}

}  // namespace segorient::detail
