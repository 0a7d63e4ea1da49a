// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/occupancy.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {

/// The sides that a scene was seen from, where places inside of it explain the densities and those
/// around it do not, but too many do to tell which: a scanner that was carried along, frames of a
/// depth camera.
/// \return 3 floats a piece: the mean direction to where it was seen from; empty where nothing, or
///         not enough, says that it was seen from within
std::vector<float> directionsWithin(const DensityPatches& patches, const Occupancy& occupancy,
                                    const Extent& extent, int threads);

}  // namespace segorient::detail
