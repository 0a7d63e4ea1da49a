// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

namespace segorient::detail {

/// Whether most points are as far from their nearest as those around are from theirs: as vertices
/// of a surface that was drawn line by line, or the points of one scanner. Those that several
/// scanners saw fall at random.
/// \param index of `points`
bool formALattice(const PointView& points, const search::MedianHashIndex& index, int threads);

}  // namespace segorient::detail
