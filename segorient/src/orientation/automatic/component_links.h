// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_result.h>

#include <vector>

#include "orientation/automatic/sheet_signs.h"

namespace segorient::detail {

/// Components whose side nothing tells take that of what is nearest beside them: rows of points
/// much nearer to each other than to the next row, as around the poles of a sphere whose points lie
/// on circles of latitude, have no neighbours but themselves, and are too narrow for a winding
/// number of their own. The nearest points that are not in the component vote as those of a border
/// do (borderVotes()), unless they lie before or behind it: whether two sheets face each other or
/// turn their backs, no neighbour knows.
///
/// \param known one a component: whether its side is, whatever decided it
/// \param components decided by all else; those decided by DecidedBy::NOTHING that are no open
///        ground, and have as many points as a winding number takes, get their sign and
///        DecidedBy::SURROUNDINGS. Where such are linked with each other only, the largest keeps
///        its sign
void followNearest(const SheetSigns& sheets, const std::vector<bool>& known,
                   std::vector<ComponentOrientationResult>& components);

}  // namespace segorient::detail
