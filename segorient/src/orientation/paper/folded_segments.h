// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// Regular segments that are not one sheet over the plane across their reference normal, which the
/// paper asks of every segment (3.2.1): growing ran over from one body to another that touches it.
///
/// The plane is cut into squares of four spacings; a square is double if the heights of its points
/// have a gap of more than four spacings, with at least two points on either side. More than a
/// tenth of a folded segment's points are in double squares. Growing bounds
/// the slope of a sheet to beta + epsilon, so one sheet has no such gap.
/// \param threads see resolveThreads()
/// \return labels, ascending
std::vector<std::int32_t> findFoldedSegments(const PointView& points,
                                             const Neighborhoods& neighborhoods,
                                             const Segmentation& segmentation, int threads = 0);

}  // namespace segorient
