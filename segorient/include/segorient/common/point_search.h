// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>

#include <functional>
#include <vector>

namespace segorient {

/// k nearest of one of a cloud's points, itself included, as indices into the cloud: a user's own
/// search method.
using PointSearch = std::function<int(pcl::index_t point, int k, pcl::Indices& indices,
                                      std::vector<float>& sqr_distances)>;

}  // namespace segorient
