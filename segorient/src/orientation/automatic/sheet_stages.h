// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "orientation/automatic/sheet_signs.h"

namespace segorient::detail {

/// Stages of orientSheets(), in this order.

/// Components outward by the winding number, parts of them whose borders hardly tell with it; where
/// nothing is outward, by convention (+z); hints go before.
void turnComponentsOut(SheetSigns& sheets);

/// Clusters that contradict seeds, normals or the viewpoint that are known.
void followHints(SheetSigns& sheets);

/// What a known sensor saw faces it: whole segments, whatever their borders say, and the segments
/// around them as borders say. Where nobody knows a sensor but the upper side of ground is the seen
/// one, clusters follow as a whole, and no segments around.
void followSensors(SheetSigns& sheets);

/// Signs and confidences of segments, clusters and points, and the borders that contradict them. A
/// segment's confidence: how far its borders agree with the signs that were found.
void judge(SheetSigns& sheets);

/// Of segments that mix what was seen from two sides, each point as its sensor says. After judge().
void believeSensors(SheetSigns& sheets);

}  // namespace segorient::detail
