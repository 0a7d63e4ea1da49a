// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include "search/prepared_cloud.h"

namespace segorient::detail {

/// findSensors() of a cloud that is prepared.
/// \param points the rows that it was prepared from, for an image
SensorReport sensorsOf(const PointView& points, PreparedCloud& cloud, const SensorOptions& options);

}  // namespace segorient::detail
