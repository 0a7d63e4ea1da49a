// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/occupancy.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {

/// The sides that a scene was seen from.
struct SeenWithin {
  /// 3 floats a piece: the mean direction to where it was seen from; empty where nothing, or not
  /// enough, says that it was seen from within.
  std::vector<float> directions;
  /// Of the places that it may have been seen from, the heaviest first.
  std::vector<std::array<double, 3>> places;
};

/// Where places inside of a scene explain the densities and those around it do not, but too many do
/// to tell which: a scanner that was carried along, frames of a depth camera.
SeenWithin seenWithin(const DensityPatches& patches, const Occupancy& occupancy,
                      const Extent& extent, int threads);

}  // namespace segorient::detail
