// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <vector>

namespace segorient::segmentation {

/// Final label of each provisional one, -1 for those without points: descending size, equal sizes
/// by smallest member.
SEGORIENT_SEGMENTATION_EXPORT std::vector<std::int32_t> rankLabels(
    const std::vector<std::int32_t>& labels, const std::vector<std::uint32_t>& sizes,
    std::size_t& count);

}  // namespace segorient::segmentation
