// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/search/median_hash_index.h>

#include <cstddef>
#include <vector>

#include "features/cloud_noise.h"

namespace segorient::detail {

/// Whether the k nearest of a row spread in two directions, see kOneLine. Of those along one line,
/// as a scanner's lines have them, planes and triangles may face anywhere around it: what the
/// surface bends along the line turns them, and they fit nonetheless.
bool spreads(const Surroundings& of, std::size_t row, int k);

/// Whether a scanner saw the cloud by lines: the nearest ten of many points are of one line.
bool seesLines(const Surroundings& of);

/// Gives rows the plane of their nearest neighbours, as few as spread in two directions: 12, half
/// as many again each time, 60 at most. Where none do, or that plane is of two faces, rows keep
/// what they have.
/// \param index of the points, for more than the table has, or null
/// \param normals 4 floats a row: unit normal, smallest variance in the sum of all
/// \return how many rows got one
std::size_t takeSpreadPlanes(const Surroundings& of, const search::MedianHashIndex* index,
                             const std::vector<pcl::index_t>& rows, int threads, float* normals);

}  // namespace segorient::detail
