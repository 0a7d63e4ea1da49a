// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>

#include <vector>

#include "orientation/sensors/flat_points.h"

namespace segorient::detail {

/// The sides that a room was seen from, by shadows alone: thinned clouds have lost their densities.
///
/// From places deep inside of a body, what is hidden is there as well as what hides it. In a room,
/// what nobody in it saw is missing: surfaces end where the shadows of what stands in it begin, for
/// most of the places that somebody could have stood in.
/// \param flat made from the points
/// \return 3 floats a point: the mean direction to the places that it could be seen from; empty
///         where nothing, or not enough, says that it was seen from within
std::vector<float> directionsInARoom(const PointView& points, const FlatPoints& flat, int threads);

/// Whether surfaces that were oriented go on everywhere, as around bodies: what shadows took from a
/// room leaves borders that contradict each other.
SEGORIENT_ORIENTATION_EXPORT bool boundBodies(
    const std::vector<ComponentOrientationResult>& components);

}  // namespace segorient::detail
