// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>

namespace segorient::program {

using Vec = std::array<float, 3>;

/// Normals at most 35 degrees apart, as a cosine, may be of one surface; else an edge is between.
constexpr float kSameSheet = 0.82F;

inline float dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vec vectorAt(const float* p) {
  return {p[0], p[1], p[2]};
}

}  // namespace segorient::program
