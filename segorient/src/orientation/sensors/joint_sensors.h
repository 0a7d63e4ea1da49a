// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include "orientation/sensors/density_patches.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// What no single place explains: several stations, a scanner on its way, or an aircraft are put
/// into the report if they are sure, in the coordinates of these points.
/// \param upright the cloud, if that has these coordinates; in others nothing is above
/// \param report has the deviation, and no sensors
void findSeveral(const PointView& points, const DensityPatches& patches, PreparedCloud* upright,
                 int threads, SensorReport& report);

/// The same, of a scanner on its way alone.
void findMoving(const PointView& points, const DensityPatches& patches, int threads,
                SensorReport& report);

}  // namespace segorient::detail
