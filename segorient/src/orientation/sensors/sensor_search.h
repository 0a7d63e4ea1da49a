// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <array>
#include <optional>

#include "orientation/sensors/shadows.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Shadows that need not be looked for again.
struct SeenShadows {
  /// A suggestion, in input coordinates, whose shadows reveal no sensor.
  std::optional<std::array<float, 3>> nothing_at;
  /// Found: those that told of a sensor; no steps where something else did.
  Shadows of_sensor;
  /// Found: all four sides of an image meet in the sensor.
  bool whole_image = false;
  /// Found: those of the first suggestion that do not reveal it; no steps where nobody looked.
  Shadows of_first;
  /// Found: the directions are those of a room, by shadows alone.
  bool in_a_room = false;
};

/// findSensors() of a cloud that is prepared.
/// \param points the rows that it was prepared from, for an image
SensorReport sensorsOf(const PointView& points, PreparedCloud& cloud, const SensorOptions& options,
                       SeenShadows& shadows);

}  // namespace segorient::detail
