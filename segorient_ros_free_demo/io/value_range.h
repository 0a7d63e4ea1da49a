// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/bulk_bounds.h"

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
/// (map coordinates, say). What a few strays would need does not count.
/// \param position of each of `size` points, an array of three; not finite where there is none
template <typename Position>
bool needDouble(std::size_t size, const Position& position) {
  const Bounds bulk = bulkBounds(size, position);
  return bulk.extent() > 0.0 && bulk.isFar();
}

}  // namespace segorient::program
