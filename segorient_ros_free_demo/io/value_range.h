// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace segorient::program {

/// Smallest and largest finite number among some.
class ValueRange {
 public:
  void add(double v) {
    if (!std::isfinite(v)) return;
    low_ = std::min(low_, v);
    high_ = std::max(high_, v);
  }
  bool empty() const { return low_ > high_; }
  double low() const { return low_; }
  double high() const { return high_; }
  double extent() const { return empty() ? 0.0 : high_ - low_; }
  double reach() const { return empty() ? 0.0 : std::max(std::abs(low_), std::abs(high_)); }

 private:
  double low_ = INFINITY;
  double high_ = -INFINITY;
};

/// Whether coordinates need doubles: floats resolve 1e-7 of a range only near 0, not far from it
/// (map coordinates, say).
inline bool needDouble(const std::array<ValueRange, 3>& xyz) {
  double extent = 0.0;
  double reach = 0.0;
  for (const ValueRange& r : xyz) {
    extent = std::max(extent, r.extent());
    reach = std::max(reach, r.reach());
  }
  return extent > 0.0 && reach > 2.0 * extent;
}

}  // namespace segorient::program
