// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/segmentation/segmentation.h>

namespace segorient {

/// Which segments touch: two points are neighbours if either is among the other's.
/// \param k neighbours of each row to use, the point itself not counted; 0 = all
SEGORIENT_SEGMENTATION_EXPORT SegmentGraph buildSegmentGraph(const Segmentation& segmentation,
                                                             const Neighborhoods& neighborhoods,
                                                             int k = 0);

}  // namespace segorient
