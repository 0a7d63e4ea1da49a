// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/impl/point_search.hpp>

#include "common/compact_cloud.h"

namespace segorient {

/// The neighbours of distinct points by a search on the cloud that they come from: what a user's
/// own search method finds, for the stages that work on distinct points. Repeated points are one
/// neighbour, points that the compact cloud leaves out none.
/// \param k entries of a row at most, the point itself first
void searchNeighborhoods(const CompactCloud& cloud, const PointSearch& search, int k,
                         Neighborhoods& out);

}  // namespace segorient
