// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/compact_cloud.h>
#include <segorient/common/neighborhoods.h>

#include <functional>
#include <vector>

namespace segorient {

/// k nearest of one of a cloud's points, itself included, as indices into the cloud.
using PointSearch = std::function<int(pcl::index_t point, int k, pcl::Indices& indices,
                                      std::vector<float>& sqr_distances)>;

/// The neighbours of distinct points by a search on the cloud that they come from: what a user's
/// own search method finds, for the stages that work on distinct points. Repeated points are one
/// neighbour, points that the compact cloud leaves out none.
/// \param k entries of a row at most, the point itself first
void searchNeighborhoods(const CompactCloud& cloud, const PointSearch& search, int k,
                         Neighborhoods& out);

}  // namespace segorient
