// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include <array>
#include <string>
#include <vector>

namespace segorient::program {

/// "station at (x, y, z), ...": one sensor in a line. \param origin added to its position
std::string describeSensor(const FoundSensor& sensor, const std::array<double, 3>& origin);

/// A line on standard output for each sensor that is not followed.
/// \param origin added to positions \param column where text after the line's name begins
void printNotFollowed(const std::vector<KnownSensor>& sensors, const std::array<double, 3>& origin,
                      int column);

/// The same of seeds that count for no point; nothing of none.
void printSeedsLeftOut(std::size_t seeds, int column);

}  // namespace segorient::program
