// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <vector>

namespace segorient {

/// The middle value, of an even number the upper one of the two; 0 where there is none.
/// None of the values may be NaN.
SEGORIENT_SEARCH_EXPORT float median(std::vector<float> values);

}  // namespace segorient
