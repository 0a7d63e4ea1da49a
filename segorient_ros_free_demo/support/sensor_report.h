// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include <array>
#include <string>

namespace segorient::program {

/// "station at (x, y, z), ...": one sensor in a line. \param origin added to its position
std::string describeSensor(const FoundSensor& sensor, const std::array<double, 3>& origin);

}  // namespace segorient::program
