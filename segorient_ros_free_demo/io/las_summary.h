// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>

#include "common/bulk_bounds.h"
#include "io/value_range.h"

namespace segorient::program {

struct OutputCloud;

/// What a LAS file says of all of its points before the first of them, gathered block by block.
class LasSummary {
 public:
  /// \param bulk where the points are but for strays, which LAS has no room for
  explicit LasSummary(const Bounds& bulk) : bulk_(bulk) {}

  /// The next points; all blocks have the same columns.
  void add(const OutputCloud& block);

  /// False where coordinates are not finite, or of a stray so far away that the grid of coordinates
  /// would make the others one place.
  bool hasPlace(const std::array<double, 3>& p) const { return !bulk_.isBeyondFloats(p); }
  std::uint64_t points() const { return points_; }    ///< with a place
  std::uint64_t skipped() const { return skipped_; }  ///< without
  const ValueRange& range(std::size_t axis) const { return range_[axis]; }
  std::uint64_t returns(std::size_t number) const { return returns_[number]; }
  /// Whether values need the wider fields of point formats from 6 on.
  bool isWide() const { return wide_; }
  bool hasWholeIntensities() const { return whole_intensities_; }  ///< from 0 to 65535
  double largestIntensity() const { return intensity_.empty() ? 0.0 : intensity_.high(); }

 private:
  Bounds bulk_;
  std::uint64_t points_ = 0;
  std::uint64_t skipped_ = 0;
  std::array<ValueRange, 3> range_;
  std::array<std::uint64_t, 16> returns_{};
  bool wide_ = false;
  bool whole_intensities_ = true;
  ValueRange intensity_;
};

}  // namespace segorient::program
