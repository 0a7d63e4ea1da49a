// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient::program {

/// Sorts rows of finite points along Morton's curve, so that those near each other in space mostly
/// are in the order as well. Equal places stay as they were.
/// \param first, last rows to sort
/// \param threads 0 = all cores; the result does not depend on it
void sortInSpace(const PointView& points, std::vector<std::uint32_t>::iterator first,
                 std::vector<std::uint32_t>::iterator last, int threads);

}  // namespace segorient::program
