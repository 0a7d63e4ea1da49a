// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>

#include <cstddef>
#include <vector>

#include "features/more_neighbors.h"

namespace segorient::detail {

/// Gives those points planes of up to 60 neighbours that ask for clearly more than the noise of the
/// cloud does: in scans those near the sensor, on rings, and where depth has steps. Surfaces of
/// few neighbours fit the noise there. Where only many neighbours show the noise at all, see
/// SheetTraits, each point gets its plane by estimateSheetNormals(). Not for solids: their thin
/// walls look like noise.
/// \param more the points, and their neighbours
/// \param neighborhoods kSheetNeighbors of each point beside itself
/// \param normals 4 floats a point: unoriented unit normal, smallest variance in the sum of all
/// \return how many points have one; 0 unless many points ask for it
SEGORIENT_FEATURES_EXPORT std::size_t takeScanPlanes(MoreNeighbors& more,
                                                     const Neighborhoods& neighborhoods,
                                                     int threads, std::vector<float>& normals);

}  // namespace segorient::detail
