// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace segorient {

constexpr double kPi = 3.14159265358979323846;

/// The i-th of n directions that lie evenly on the unit sphere: a spiral from z = 1 downward, each
/// turned by the golden section of a circle.
inline std::array<double, 3> evenDirection(std::size_t i, std::size_t n) {
  constexpr double kGoldenTurn = 2.0 * kPi * 0.61803398874989484820;
  const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(n);
  const double r = std::sqrt(1.0 - z * z);
  const double turn = kGoldenTurn * static_cast<double>(i);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

}  // namespace segorient
