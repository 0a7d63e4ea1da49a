// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/flat_points.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Whether a sensor was found by SensorEvidence::LAYERS or WOODS.
bool isOverGround(const SensorReport& report);

/// Puts a sensor far above into the report if the cloud is woods as lasers see them from the air:
/// beams pass between the leaves, so that points lie at all heights and on no surface, and below
/// them is the ground. Such a cloud closes as a body does, but what is on surfaces in it is one
/// surface that all the rest lies above.
/// \param flat the cloud's points on surfaces
/// \param patches of the cloud
/// \param report has one entry a point
void lookOverWoods(const FlatPoints& flat, const DensityPatches& patches, int threads,
                   SensorReport& report);

/// The same if the cloud is one surface over the ground, or woods.
/// \param patches of the cloud, whose density varies
void lookFromAbove(PreparedCloud& cloud, const DensityPatches& patches, int threads,
                   SensorReport& report);

}  // namespace segorient::detail
