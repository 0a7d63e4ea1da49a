// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>

namespace segorient {

/// A vector of three floats, for sums and squares that floats cannot hold.
inline std::array<double, 3> inDouble(const float* v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace segorient
