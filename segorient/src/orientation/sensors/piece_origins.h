// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "orientation/sensors/density_patches.h"

namespace segorient::detail {

/// Which of several places pieces of surface were seen from.
struct PieceOrigins {
  std::vector<std::int32_t> place;  ///< by piece: the place that most of its points come from
  /// By piece: 1 = what places on one side of it leave is not far from what those on the other do.
  std::vector<std::uint8_t> either_side;
};

/// For each piece the place that left most of its points, among those on the side of the surface
/// that most points come from: several places on one side outweigh a nearer one on the other.
/// \param rows by place and piece, what each left
PieceOrigins strongestPlaces(const DensityPatches& patches,
                             const std::vector<std::array<double, 3>>& places,
                             const std::vector<std::vector<float>>& rows);

}  // namespace segorient::detail
