// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/occupancy.h"
#include "orientation/sensors/piece_origins.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {

/// A sensor that went along a straight level line inside the scene while it turned about the z
/// axis: a lidar on a vehicle. Its beams are nobody's grid: how many there are by elevation is
/// found with the line.
struct Track {
  std::vector<std::array<double, 3>> places;  ///< from one end to the other, equally far apart
  std::vector<float> beams;                   ///< by elevation, from straight down, relative
  float cost = 0.F;                           ///< as costOf()
};

/// Nothing where that is hopeless.
std::optional<Track> searchTrack(const DensityPatches& patches, const Extent& extent, int threads);

/// The best line beside a track if each place leaves points only on what nothing hides from it.
Track settleInSight(const DensityPatches& patches, const Extent& extent, const Occupancy& occupancy,
                    const Track& track);

/// Which of the track's places the pieces were seen from.
PieceOrigins originsOf(const DensityPatches& patches, const Occupancy& occupancy,
                       const Track& track);

}  // namespace segorient::detail
