// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include "orientation/sensors/camera_views.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Sensors whose law of sampling explains how dense the points are on each surface, and one layer
/// over the ground, or woods, which somebody above saw.
/// \param views cameras that images and shadows tell of: where they explain densities about as well
///        as the best of all places, they are that
/// \return in the unit of the cloud; SensorReport::sensor_of has one entry for each of its points
SensorReport searchByDensity(PreparedCloud& cloud, const SensorOptions& options,
                             CameraViews& views);

}  // namespace segorient::detail
