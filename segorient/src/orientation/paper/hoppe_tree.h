// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>

namespace segorient {

/// The classical method, for comparison: a minimum spanning tree over all points, an edge between
/// neighbours costing 1 - |n_p . n_q|, along which signs spread from the highest point of each
/// component, whose normal points up (Hoppe et al. 1992).
/// \return segments are left empty; ties go to the earlier point
OrientationResult orientByPointTree(const PointView& points, const PointView& normals,
                                    const Neighborhoods& neighborhoods);

}  // namespace segorient
