// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/from_above.h"
#include "orientation/sensors/scene_frame.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// What no single place explains: several stations, a scanner on its way, or an aircraft are put
/// into the report if they are sure, in the unit of the cloud and by its points.
/// \param has_axes whether the scene lies along the coordinate axes: scanners that tilt are sought
///        about those that are level then
/// \param above of the cloud
/// \param report has the deviation, and no sensors
void findSeveral(PreparedCloud& cloud, const DensityPatches& patches, bool has_axes,
                 FromAbove& above, int threads, SensorReport& report);

/// Several stations, or a scanner on its way, or the side, of a scene that lies otherwise in the
/// cloud's coordinates. Which of the frame's axes is up its largest plane does not tell for sure,
/// as that may be a wall: the one that explains most.
void findSeveralTurned(SceneFrame frame, PreparedCloud& cloud, const DensityPatches& patches,
                       int threads, SensorReport& report);

}  // namespace segorient::detail
