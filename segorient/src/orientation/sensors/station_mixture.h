// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/occupancy.h"

namespace segorient::detail {

/// Places whose mixture explains the densities, each with any weight, those near each other taken
/// together: a start for searchStations(), the heaviest first.
std::vector<std::array<double, 3>> mixturePlaces(const DensityPatches& patches,
                                                 const Occupancy& occupancy, const Extent& extent,
                                                 const std::array<double, 3>& axis, int threads);

}  // namespace segorient::detail
