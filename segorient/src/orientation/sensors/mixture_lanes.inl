// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Sums over rows of a mixture, for one instruction set; see lanes.inl. Rows are whole blocks of
// kSums.

#include "common/lanes.inl"

/// sum += weight * row
inline void addRow(const float* row, float weight, std::size_t length, float* sum) {
  for (std::size_t i = 0; i < length; i += kWidth) {
    store(sum + i, load(sum + i) + weight * load(row + i));
  }
}

/// kSums parts of the scalar product.
inline void multiplyRows(const float* a, const float* b, std::size_t length, float* parts) {
  constexpr std::size_t kRegisters = kSums / kWidth;  // for the sums
  Lanes sums[kRegisters] = {};
  for (std::size_t i = 0; i < length; i += kSums) {
    for (std::size_t r = 0; r < kRegisters; ++r) {
      sums[r] += load(a + i + r * kWidth) * load(b + i + r * kWidth);
    }
  }
  for (std::size_t r = 0; r < kRegisters; ++r) store(parts + r * kWidth, sums[r]);
}
