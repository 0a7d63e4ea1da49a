// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

namespace segorient::detail {

/// The options with those of version 1.0 that were set in the places that they have now.
PipelineOptions withFormerSettings(const PipelineOptions& options);

}  // namespace segorient::detail
