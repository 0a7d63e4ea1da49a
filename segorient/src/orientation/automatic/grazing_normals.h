// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <vector>

#include "features/more_neighbors.h"
#include "orientation/automatic/sheet_filter.h"

namespace segorient::detail {

/// Normals that contradict how densely a sensor sees: a surface is sampled in proportion to the
/// cosine of the angle at which it is seen, so that few points lie on what is seen at a grazing
/// angle. Where a normal says that, and the plane of the points farther around was seen face on,
/// noise, a single scan line or the rim of what hides it has turned the normal; it becomes that of
/// the plane, facing the sensor.
/// For clouds whose noise or scan lines leave the nearest points no say, see needsScanScales(); on
/// others small neighbourhoods show the true edges of what was seen.
/// \param more the points, and neighbours as far as such planes reach
/// \param toward 3 a point: unit vector to its sensor; 0 = unknown, and the normal stays
/// \param filtered final normals; changed
void replaceGrazingNormals(MoreNeighbors& more, const std::vector<float>& toward, int threads,
                           FilteredNormals& filtered);

}  // namespace segorient::detail
