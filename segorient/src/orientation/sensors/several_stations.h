// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/occupancy.h"
#include "orientation/sensors/piece_origins.h"

namespace segorient::detail {

/// Stations of one scanner, each of which sent the same rays: the density is the sum of what they
/// leave where they can see.
struct Stations {
  std::vector<std::array<double, 3>> positions;
  Place rays;        ///< of all of them, its position unused
  float cost = 0.F;  ///< as costOf()
};

/// The smallest number of stations that explains the densities as well as any number does; nothing
/// where there is none to start from.
/// \param rays of all of them, its position unused
/// \param most of them
std::optional<Stations> searchStations(const DensityPatches& patches, const Occupancy& occupancy,
                                       const Place& rays, std::size_t most, int threads);

/// Which of the stations the pieces were seen from.
PieceOrigins originsOf(const DensityPatches& patches, const Occupancy& occupancy,
                       const Stations& stations);

}  // namespace segorient::detail
