// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/sensors.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "orientation/sensors/known_sensors.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Whether a search may know more than places that were given point by point: more than a hundredth
/// of the points has none that is followed, or nothing confirms one of them.
/// \param scans what became of them
bool leavesDoubt(const std::vector<KnownSensor>& scans, const PreparedCloud& cloud);

/// Places that were given point by point, completed by what a search found without them: rows that
/// have none take it, and all rows of scans that are not used, or that it contradicts. It may
/// contradict a scan that nothing confirms, and any once one is not used, as poses that were mixed
/// up are wrong together. It does if most of the scan's points were seen from another direction.
/// What contradicts confirmed scans of most points takes no place.
/// \param given viewpoints by row
/// \param found the same, of sensors that are sure
/// \param either_side one a point, as SensorReport has it: rows of these take none; empty = none
/// \param seen by the sensors that were given: both members are filled
/// \param scans the sensors; what is contradicted is no longer used
/// \return none where that changes nothing
std::optional<OrientationHints> completePlaces(const OrientationHints& given,
                                               const OrientationHints& found,
                                               const std::vector<std::uint8_t>& either_side,
                                               const PreparedCloud& cloud, const SeenPoints& seen,
                                               std::vector<KnownSensor>& scans);

}  // namespace segorient::detail
