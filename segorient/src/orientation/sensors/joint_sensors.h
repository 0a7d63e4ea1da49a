// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include "orientation/sensors/density_patches.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// What no single place explains: several stations, a scanner on its way, or an aircraft are put
/// into the report if they are sure, in the unit of the cloud and by its points.
/// \param report has the deviation, and no sensors
void findSeveral(PreparedCloud& cloud, const DensityPatches& patches, int threads,
                 SensorReport& report);

}  // namespace segorient::detail
