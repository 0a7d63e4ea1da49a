// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>

namespace segorient::search {

/// A radius as a number of neighbours, for stages that take the same number everywhere: the median
/// over the cloud of how many other points lie within it. Repeated points count once, points with
/// NaN or infinite coordinates not at all; at most kMostNeighborsWithin. Does not depend on the
/// order of the points.
/// \param radius above 0
/// \param threads 0 = all cores
/// \return 0 where most points have no other one so near
SEGORIENT_SEARCH_EXPORT int medianNeighborsWithin(const PointView& points, double radius,
                                                  int threads);

/// More cost memory and tell a stage nothing new about the surface around a point.
constexpr int kMostNeighborsWithin = 128;

}  // namespace segorient::search
