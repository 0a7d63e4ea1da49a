// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/search/median_hash_index.h>

#include <vector>

#include "features/cloud_noise.h"

namespace segorient::detail {

/// Gives rows whose few neighbours tell no slope of a quadratic surface, as those of two lines, the
/// surface of as few more of them as do, 32 at most, see tellsSlope(). Where noise explains none of
/// these, rows keep what they have.
/// \param index of the points, for what the table does not have, or null
/// \param rows ascending \param noise as a length
/// \param normals 4 floats a row of the table
/// \return the rows that got none, ascending
std::vector<pcl::index_t> takeAcrossLines(const Surroundings& of,
                                          const search::MedianHashIndex* index,
                                          const std::vector<pcl::index_t>& rows, double noise,
                                          int threads, float* normals);

}  // namespace segorient::detail
