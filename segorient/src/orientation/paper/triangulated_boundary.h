// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>
#include <segorient/surface/segment_mesh.h>

#include <vector>

#include "orientation/paper/segment_relations.h"

namespace segorient {

/// The paper's boundary test (3.2.2): chains of boundary points of one segment's triangulation
/// whose neighbours lie on the other's boundary, and whether the two boundaries run in opposite
/// directions along them.
///
/// Every pair of neighbouring boundary points votes with the cosine between the two directions, so
/// several chains are settled by their lengths. Directions are taken over five boundary points, as
/// the boundary of random samples is jagged. The margin is small where triangulations are thin or
/// overlap.
/// \param meshes by label, see triangulateSegments(); an empty one has no votes
std::vector<BoundaryVote> triangulatedBoundaryVotes(const PointView& points,
                                                    const Segmentation& segmentation,
                                                    const SegmentGraph& links,
                                                    const std::vector<SegmentMesh>& meshes);

}  // namespace segorient
