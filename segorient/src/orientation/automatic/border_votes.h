// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <cstdint>
#include <vector>

#include "segmentation/sheet_segmentation.h"

namespace segorient {

/// Votes on the relative sign of two segments or clusters of them.
struct Evidence {
  float weight = 0.F;    ///< sum of votes: above 0 where the two agree as they are
  float absolute = 0.F;  ///< sum of their absolute values
  float reliable = 0.F;  ///< part of `absolute` from points whose normal is reliable
  /// |weight| / absolute: 1 where all votes agree.
  float unanimity() const {
    return absolute > 0.F ? (weight < 0.F ? -weight : weight) / absolute : 0.F;
  }
  /// \param sign -1 for votes on one of the two turned over
  void add(const Evidence& o, float sign = 1.F) {
    weight += sign * o.weight;
    absolute += o.absolute;
    reliable += o.reliable;
  }
  /// Whether votes across walls count beside these on one sheet: where two surfaces also meet at an
  /// edge, their walls have no say.
  bool letsCount(const Evidence& wall) const { return wall.absolute > 0.5F * absolute; }
};

/// What the points along one border say about the relative sign of two segments.
struct BorderVote : Evidence {
  std::int32_t a = 0;  ///< smaller label
  std::int32_t b = 0;  ///< larger label
  Evidence wall;       ///< votes across walls, part of the others only if `wall_counts`
  bool wall_counts = false;
  std::uint32_t count = 0;  ///< votes that count
  pcl::index_t where = -1;  ///< a point of the border
  /// Whether planes of more points decided: then `weight` is `absolute` times how far these agree,
  /// and none of it is of walls.
  bool by_planes = false;

  /// The votes on one sheet alone.
  Evidence sheet() const {
    if (!wall_counts) return *this;
    return {weight - wall.weight, absolute - wall.absolute, reliable - wall.reliable};
  }
};

/// Votes of all borders, ascending by (a, b).
///
/// A border point compares its own group of neighbours with each foreign group on its sheet. With
/// mean normals n and m and the chord D between the groups' means, its vote is n.m - 2 (n.D)(m.D) /
/// |D|^2: the cosine between the normals after reflection at the chord's perpendicular plane, which
/// is 1 for consistent normals at any dihedral angle, convex or concave, if the chord is symmetric.
/// Groups on another wall vote -n.m: the walls of a plate face apart. Parallel groups above each
/// other are walls, too; see Evidence::letsCount().
///
/// Where the points of a longer border contradict each other, as noise across a sharp crease makes
/// them, planes of more points on either side of it decide, if these agree. So they do where walls
/// have a say, but the planes are those of terraces: chords from one to the other rise as steeply
/// as those around the rim of a plate.
///
/// \param segmentation with a segment for each label
/// \param voters one a point: 0 for those that have no vote; null = all vote
/// \return the same for any number of threads
std::vector<BorderVote> borderVotes(const PointView& points, const Neighborhoods& neighborhoods,
                                    const SheetField& field, const Segmentation& segmentation,
                                    int threads = 0,
                                    const std::vector<std::uint8_t>* voters = nullptr);

}  // namespace segorient
