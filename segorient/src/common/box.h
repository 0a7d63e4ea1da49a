// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace segorient {

/// The axis along which a box is longest; the first of several.
inline std::size_t longestAxis(const float* low, const float* high) {
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    // Halves, since the extent itself may overflow.
    if (high[a] / 2 - low[a] / 2 > high[axis] / 2 - low[axis] / 2) axis = a;
  }
  return axis;
}

/// The box around some points; empty before the first one.
struct Box {
  std::array<float, 3> low;
  std::array<float, 3> high;

  Box() {
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
  }
  void add(const float* p) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  }
  bool contains(const float* p, float margin) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (p[a] < low[a] - margin || p[a] > high[a] + margin) return false;
    }
    return true;
  }
  /// Whether all of another box is strictly inside.
  bool encloses(const Box& other) const {
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) {
      inside = inside && low[a] < other.low[a] && other.high[a] < high[a];
    }
    return inside;
  }
  std::array<float, 3> center() const {
    std::array<float, 3> out{};
    for (std::size_t a = 0; a < 3; ++a) out[a] = 0.5F * (low[a] + high[a]);
    return out;
  }
  float diagonal() const {
    float squares = 0.F;
    for (std::size_t a = 0; a < 3; ++a) squares += (high[a] - low[a]) * (high[a] - low[a]);
    return std::sqrt(squares);
  }
  std::size_t longestAxis() const { return segorient::longestAxis(low.data(), high.data()); }
  float longestSide() const { return high[longestAxis()] - low[longestAxis()]; }
};

}  // namespace segorient
