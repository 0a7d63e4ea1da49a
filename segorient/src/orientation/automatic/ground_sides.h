// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <vector>

#include "orientation/automatic/sheet_signs.h"

namespace segorient::detail {

/// How far each component faces up as one layer over the xy plane does, such as open ground with
/// what stands on it: the share of the columns of a grid that have one layer, which faces up, less
/// the share of those where it faces down. Near 0 for what is closed, which has a top above each
/// bottom, and where only walls are. 0 where the layer as a whole is steeper than 45 degrees, and
/// where the user says that the surface is closed.
std::vector<float> facingUp(const SheetSigns& sheets);

/// What a layer of ground that is alone over its column says of the cluster that it belongs to: it
/// faces as its component does. \param up what facingUp() says of components
std::vector<Ballot> groundVotes(const SheetSigns& sheets, const std::vector<float>& up);

}  // namespace segorient::detail
