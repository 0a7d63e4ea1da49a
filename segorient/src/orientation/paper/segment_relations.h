// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/segmentation/segmentation.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// Cosine of the angle between the two segments of each link, in [-1, 1]; signed: positive means
/// that the segments are consistent as they are.
///
/// Reference normals of segments that were parted by the growing angle alone differ by about that
/// angle, so they cannot tell a smooth border from a sharp one; the pairs at the border can. Pairs
/// that face each other across a gap count as cosine 0.
/// \param threads see resolveThreads()
std::vector<float> segmentCosines(const PointView& points, const PointView& normals,
                                  const Segmentation& segmentation, const SegmentGraph& links,
                                  SegmentAngle angle, int threads = 0);

/// What the boundaries of two neighbouring segments say about their relative orientation.
struct BoundaryVote {
  float margin = 0.F;        ///< in [-1, 1]: sum of votes / sum of |votes|; positive: consistent
  std::uint32_t points = 0;  ///< border points on the side that has fewer of them

  /// Whether the vote decides: a chain needs two points, and a clear majority of its length.
  bool decides(float min_margin) const {
    return points >= 2 && (margin >= min_margin || -margin >= min_margin);
  }
};

/// The paper's boundary test (3.2.2) without a triangulation: each segment's boundary is walked
/// with the segment on its left, seen from the tip of its normals; two segments are consistent if
/// they walk their common border in opposite directions.
///
/// At a border point p of segment a the direction of the walk is n x c, c the tangent direction
/// out of a and across the border, from the neighbours on both sides. Holds for any dihedral angle
/// of about 45 degrees and more, convex or concave. One vote a pair; where the border is not clear
/// (thin segments, overlapping sheets, blades, noise) votes cancel and the margin shows it.
/// \param threads see resolveThreads()
std::vector<BoundaryVote> localBoundaryVotes(const PointView& points, const PointView& normals,
                                             const Neighborhoods& neighborhoods,
                                             const Segmentation& segmentation,
                                             const SegmentGraph& links, int threads = 0);

}  // namespace segorient
