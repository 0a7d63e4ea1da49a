// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_result.h>

#include <vector>

#include "orientation/automatic/sheet_signs.h"

namespace segorient::detail {

/// Open components face the place where a sensor may have stood (OrientationHints::suggested), if
/// nothing tells of any, and all of the cloud may be an image from there, or a few side by side: it
/// is 20 to 110 degrees wide, and nothing is near the place; or shadows suit it. Thinned images
/// have lost the densities, and often the shadows, that tell of their camera. Components that turn
/// as much towards the place as away from it keep their side, as do, unless shadows suit it, closed
/// ones, and land, if the place does not lie under it as a camera does that looks along +z.
///
/// \param components decided by all else; of those that face the place the other way the sign is
///        changed, and nothing is sure of it
/// \return of each component, whether it faces the place now
std::vector<bool> faceSuggestedPlace(SheetSigns& sheets,
                                     std::vector<ComponentOrientationResult>& components);

}  // namespace segorient::detail
