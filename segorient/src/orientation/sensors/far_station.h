// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "orientation/sensors/station_search.h"

namespace segorient::detail {

/// Diagonals of the scene: from farther away distances hardly differ, and a law is one of incidence
/// alone.
constexpr double kFarthest = 10.0;

/// The side of a place that is so far away that the same place across the scene explains the
/// densities as well, as of a scanner whose rays are parallel.
///
/// A suggested place one to ten diagonals beside the scene that sees all from one side tells.
/// \param is_even whether densities vary so little that distances can tell nothing there
/// \param suggestions places that the sensor may have been in, in the patches' unit
/// \return the place itself, or the one across; nothing where either may be it
std::optional<FittedPlace> sideOfFarPlace(const DensityPatches& patches, const FittedPlace& found,
                                          bool is_even,
                                          const std::vector<std::array<float, 3>>& suggestions);

}  // namespace segorient::detail
