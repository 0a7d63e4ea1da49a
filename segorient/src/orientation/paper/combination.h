// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/segmentation/segmentation.h>

#include <vector>

#include "orientation/paper/extremal_points.h"
#include "orientation/paper/segment_relations.h"

namespace segorient {

/// What the methods decide from. All refer to the same segmentation and links.
struct SegmentEvidence {
  const Segmentation& segmentation;
  const SegmentGraph& links;
  const std::vector<float>& cosines;              ///< by link, see segmentCosines()
  const std::vector<BoundaryVote>& boundary;      ///< by link
  const std::vector<ExtremalEvidence>& extremal;  ///< by segment
};

// Each of the following orients the regular segments relative to each other; `component` numbers
// the connected components of the links by smallest label. Segments of other kinds keep sign 0.
// Deciding is deterministic: the surest link first, equal ones by label. Of the settings these look
// at gamma, min_margin and check_borders: where angle and boundary of a link both decide, and not
// the same, neither does (beyond the paper: at blades the angle is wrong, at unclear borders the
// boundary).

/// Spanning tree over the angles (paper, 3.1). A segment whose smallest angle to its oriented
/// neighbours is between gamma and pi - gamma follows that angle's sign, marked as hard.
std::vector<SegmentOrientationResult> propagateOrientation(const SegmentEvidence& evidence,
                                                           const OrientationSettings& options);

/// Spanning tree over the boundary votes (paper, 3.2.2). A segment that no oriented neighbour's
/// boundary decides follows the balance of all of them, marked as hard.
std::vector<SegmentOrientationResult> orientByBoundaries(const SegmentEvidence& evidence,
                                                         const OrientationSettings& options);

/// The tree over the angles; where its angle does not decide, the oriented neighbours by size, one
/// after the other, by their boundaries; hard to orient segments again whenever one of their
/// neighbours was oriented (paper, end of 3.2.2); what is left then by extremal points, or else by
/// the best evidence there is, marked as hard.
std::vector<SegmentOrientationResult> orientCombined(const SegmentEvidence& evidence,
                                                     const OrientationSettings& options);

/// Every segment that an extremal point reaches, by that (paper, 3.3); the others from these as in
/// orientCombined().
std::vector<SegmentOrientationResult> orientByExtremalPoints(const SegmentEvidence& evidence,
                                                             const OrientationSettings& options);

}  // namespace segorient
