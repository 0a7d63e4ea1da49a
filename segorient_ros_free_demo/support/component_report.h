// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_result.h>

#include <vector>

#include "support/json.h"

namespace segorient::program {

/// As the array `components` of a report.
void addTo(JsonWriter& json, const std::vector<ComponentOrientationResult>& components);

}  // namespace segorient::program
