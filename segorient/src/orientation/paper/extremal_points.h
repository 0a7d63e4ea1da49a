// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <vector>

namespace segorient {

/// A point that nothing of the object lies beyond in a direction of an axis, as far as a
/// subdivision of space can tell, and what its normal says about its segment.
struct ExtremalPoint {
  pcl::index_t point = 0;
  std::int8_t sign = 0;  ///< +1: its input normal points out of the object, -1: into it
  float angle = 0.F;     ///< between normal line and direction, radians in [0, pi/2]
};

/// What the extremal points say about one segment.
struct ExtremalEvidence {
  float angle = 0.F;     ///< M_CA of the paper: the smallest angle seen; gamma where there was none
  std::int8_t sign = 0;  ///< of the reference normal by that point; 0 = not reached
  /// What all the segment's extremal points say about that sign, each by the cosine of its angle:
  /// 1 all agree, -1 all but that one contradict.
  float agreement = 0.F;
  int votes = 0;  ///< number of extremal points within gamma
};

/// One extremal point per box and free direction, ties by index (paper, 3.3). Holds for closed
/// objects: at the rim of an open one, the inside is taken for outside.
/// \param rows points to subdivide; all of them have a normal
/// \param max_box_points m of the paper
/// \param threads see resolveThreads()
/// \return in order of the boxes; a point can occur in several directions
std::vector<ExtremalPoint> findExtremalPoints(const PointView& points, const PointView& normals,
                                              const std::vector<pcl::index_t>& rows,
                                              std::size_t max_box_points, int threads = 0);

/// M_CA and votes per segment; only regular segments get evidence, as only they are oriented in
/// themselves.
/// \param gamma radians; extremal points with a larger angle say nothing
std::vector<ExtremalEvidence> gatherExtremalEvidence(const std::vector<ExtremalPoint>& extremal,
                                                     const Segmentation& segmentation, float gamma);

}  // namespace segorient
