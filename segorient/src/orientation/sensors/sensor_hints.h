// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/sensors.h>

#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Whether it is worth looking for sensors: none is known, no normals are, and the cloud is not
/// said to be closed.
bool lacksSensors(const OrientationHints& hints);

/// Looks for sensors; what is sure becomes a hint of each row, as if it were given.
/// \param points the rows that `cloud` was prepared from
SensorReport addFoundSensors(const PointView& points, PreparedCloud& cloud, int threads,
                             OrientationHints& hints);

}  // namespace segorient::detail
