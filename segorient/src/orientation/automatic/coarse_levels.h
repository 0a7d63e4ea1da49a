// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "orientation/automatic/orient_points.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// Orients a cloud whose neighbours are known, at its own scale.
using OrientOneScale =
    std::function<AutoNormals(const PointView&, const Neighborhoods&, const PointHints&)>;

/// An even subset of a cloud, prepared for being oriented.
struct CoarseLevel {
  PreparedCloud cloud;                 ///< with neighbours
  std::vector<std::uint32_t> point;    ///< by point of it: which of the cloud's it is
  std::vector<std::uint32_t> nearest;  ///< by point of the cloud: the nearest of the subset
  AutoNormals found;                   ///< its orientation, by whoever makes that
};

/// Each point of the subset is where the points that it stands for are in the mean, which is on the
/// one surface that scans on both sides of it make.
/// \param radius no two first points of these are nearer; in the unit of the points
/// \param frame see compactCloud(); null = of the points: a level has the order of its cloud
/// \return without points where there is nothing to thin out
SEGORIENT_ORIENTATION_EXPORT CoarseLevel makeLevel(const PointView& points, float radius,
                                                   int threads, const Bounds* frame = nullptr);

/// Takes the signs of a coarser scale where a cloud's own points contradict each other: scans that
/// lie half a spacing to a spacing apart are two surfaces at the scale of the points, which cross,
/// and one at twice that scale.
///
/// Even subsets of growing radius are oriented, each sign goes to the points around, and SignEnergy
/// chooses; the points' own scale stays unless another one has clearly less. Without
/// contradictions, as in clean clouds and thin walls, nothing is done that costs anything.
///
/// Hints hold at every scale: a subset's points have those of the points that they stand for, and
/// sensors that the cloud itself made out.
///
/// \param fine what orient() found for all points; signs, confidences and components may be
///        replaced
/// \return the radius of the subset that was chosen, in mean distances to the six nearest; 0 = none
float followCoarserLevels(const PointView& points, const Neighborhoods& neighborhoods,
                          const PointHints& hints, const OrientOneScale& orient, int threads,
                          AutoNormals& fine);

}  // namespace segorient::detail
