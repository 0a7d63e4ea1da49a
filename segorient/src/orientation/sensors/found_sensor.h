// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

namespace segorient::detail {

/// Makes one sensor the one that saw all points.
/// \param out has one entry a point
void setOnly(const FoundSensor& sensor, const char* why, SensorReport& out);

/// Whether a sensor was found by SensorEvidence::LAYERS or WOODS.
bool isOverGround(const SensorReport& report);

}  // namespace segorient::detail
