// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cmath>
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

}  // namespace segorient
