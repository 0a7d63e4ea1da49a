// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace segorient {

/// Three floats of any length at length 1, in double: squares of what floats can hold neither
/// overflow nor vanish. NaN if all are zero or one is not finite.
inline void unitVector(const float* v, float* out) {
  double squares = 0.0;
  for (int a = 0; a < 3; ++a) squares += static_cast<double>(v[a]) * static_cast<double>(v[a]);
  const bool usable = squares > 0.0 && std::isfinite(squares);
  const double factor =
      usable ? 1.0 / std::sqrt(squares) : std::numeric_limits<double>::quiet_NaN();
  for (int a = 0; a < 3; ++a) out[a] = static_cast<float>(static_cast<double>(v[a]) * factor);
}

/// The same of doubles. \return false, and `out` as it was, where there is no direction
inline bool unitVector(const std::array<double, 3>& v, float* out) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 0.0) || !std::isfinite(length)) return false;
  for (std::size_t a = 0; a < 3; ++a) out[a] = static_cast<float>(v[a] / length);
  return true;
}

/// The direction from one place to another. \return as above
inline bool directionTo(const float* from, const float* to, float* out) {
  std::array<double, 3> way{};
  for (std::size_t a = 0; a < 3; ++a) {
    way[a] = static_cast<double>(to[a]) - static_cast<double>(from[a]);
  }
  return unitVector(way, out);
}

}  // namespace segorient
