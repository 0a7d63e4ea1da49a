// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>

#include <functional>
#include <vector>

namespace segorient {

/// k nearest of one of a cloud's points, itself included, as indices into the cloud: a user's own
/// search method.
using PointSearch = std::function<int(pcl::index_t point, int k, pcl::Indices& indices,
                                      std::vector<float>& sqr_distances)>;

/// Before a user's search is asked for k neighbours: both vectors have k entries then, as they have
/// when PCL's own estimators ask. Many searches write into them without making room.
SEGORIENT_SEARCH_EXPORT void makeRoomForSearch(int k, pcl::Indices& indices,
                                               std::vector<float>& sqr_distances);

/// After it: leaves as many entries as the search says that it found, whether it resized the
/// vectors or not. \return how many there are now
SEGORIENT_SEARCH_EXPORT int keepFound(int count, pcl::Indices& indices,
                                      std::vector<float>& sqr_distances);

}  // namespace segorient
