// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <cstddef>

namespace segorient {

/// Most memory that the process has had so far, bytes; 0 where the system does not tell.
SEGORIENT_SEARCH_EXPORT std::size_t peakMemory();

}  // namespace segorient
