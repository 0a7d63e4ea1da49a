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
/// \param smallest_pivot as a share of its diagonal
/// \return how many rows it went well for: N, or the first one whose pivot was smaller
template <std::size_t N>
std::size_t decompose(SquareMatrix<N>& m, double smallest_pivot) {
  for (std::size_t j = 0; j < N; ++j) {
    const double diagonal = m[j][j];
    for (std::size_t k = 0; k < j; ++k) {
      const double product = m[j][k];  // L times D so far
      m[j][k] = product / m[k][k];
      m[j][j] -= product * m[j][k];
    }
    if (!(m[j][j] > smallest_pivot * diagonal)) return j;
    for (std::size_t i = j + 1; i < N; ++i) {
      for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
    }
  }
  return N;
}

/// Replaces the first `order` entries of x by those of the solution of L y = x.
template <std::size_t N>
void substituteForward(const SquareMatrix<N>& m, VectorN<N>& x, std::size_t order) {
  for (std::size_t i = 0; i < order; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= m[i][k] * x[k];
  }
}

/// Replaces x by the solution of L^T y = x, L being as large as x.
template <std::size_t N, std::size_t M>
void substituteBackward(const SquareMatrix<N>& m, VectorN<M>& x) {
  static_assert(M <= N, "L must be as large as x");
  for (std::size_t i = M; i-- > 0;) {
    for (std::size_t k = i + 1; k < M; ++k) x[i] -= m[k][i] * x[k];
  }
}

}  // namespace segorient::detail
