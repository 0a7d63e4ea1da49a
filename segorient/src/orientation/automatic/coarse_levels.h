// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <functional>

#include "orientation/automatic/orient_points.h"

namespace segorient::detail {

/// Orients a cloud whose neighbours are known, at its own scale.
using OrientOneScale =
    std::function<AutoNormals(const PointView&, const Neighborhoods&, const PointHints&)>;

/// Takes the signs of a coarser scale where a cloud's own points contradict each other: scans that
/// lie half a spacing to a spacing apart are two surfaces at the scale of the points, which cross,
/// and one at twice that scale.
///
/// Even subsets of growing radius are oriented, each sign goes to the points around, and SignEnergy
/// chooses; the points' own scale stays unless another one has clearly less. Without
/// contradictions, as in clean clouds and thin walls, nothing is done that costs anything.
///
/// Hints hold at every scale: a subset's points have those of the points that they stand for, and
/// sensors that the cloud itself made out; points that their sensor decided keep their side.
///
/// \param fine what orient() found for all points; signs, confidences and components may be
///        replaced
/// \return the radius of the subset that was chosen, in mean distances to the six nearest; 0 = none
float followCoarserLevels(const PointView& points, const Neighborhoods& neighborhoods,
                          const PointHints& hints, const OrientOneScale& orient, int threads,
                          AutoNormals& fine);

}  // namespace segorient::detail
