// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::segmentation {

/// Makes provisional labels final ones: by descending size, equal sizes by smallest member.
/// \return the provisional label of each final one
SEGORIENT_SEGMENTATION_EXPORT std::vector<std::size_t> rankLabels(
    const std::vector<std::uint32_t>& sizes, std::vector<std::int32_t>& labels);

}  // namespace segorient::segmentation
