// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>

#include <cstdint>
#include <vector>

namespace segorient::detail {

/// Takes back what would tear sheets: of points that are to be turned, those patches whose
/// neighbours all around agreed with them, so that after it they contradict them along a line, and
/// more of them than before. The two sides of a wall, which came out alike as noise mixes them,
/// contradict their neighbours everywhere once one of them is turned, and a patch that was wrong
/// contradicted its surroundings before.
///
/// \param normals 4 floats a point, oriented, before anything is turned; NaN where none
/// \param turned one a point
void keepSheetsWhole(const Neighborhoods& neighborhoods, const std::vector<float>& normals,
                     std::vector<std::uint8_t>& turned);

}  // namespace segorient::detail
