// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <array>
#include <cstdint>
#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {

/// Where a cloud has points, in cubes: what hides one place from another.
class Occupancy {
 public:
  /// ns for one piece and one place, see resolveThreads().
  static constexpr double kTime = 100.0;

  Occupancy(const PointView& points, const DensityPatches& patches, const Extent& extent);

  /// How much of each piece's density a sensor there can be made responsible for: 1, or little
  /// where something lies between.
  void visibility(const DensityPatches& patches, const std::array<double, 3>& place,
                  float* out) const;

 private:
  bool clear(const float* from, const float* to, float distance, float start) const;

  float side_ = 1.F;
  std::array<float, 3> low_{0.F, 0.F, 0.F};
  std::array<int, 3> count_{0, 0, 0};
  std::vector<std::uint8_t> filled_;  ///< with a layer of empty cubes all around
};

}  // namespace segorient::detail
