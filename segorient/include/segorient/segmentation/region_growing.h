// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <limits>

namespace segorient {

/// Settings of segmentByNormals(). Angles in radians, lengths in multiples of the local spacing, so
/// nothing depends on the unit or the size of a cloud.
struct SegmentationOptions {
  float alpha = 0.3490659F;  ///< largest angle between the normals of two neighbours (20 degrees)
  float beta =
      0.5235988F;  ///< largest angle between a normal and the reference normal (30 degrees)
  float epsilon = 0.1745329F;   ///< by how much the clean-up may exceed beta (10 degrees)
  std::size_t small_size = 20;  ///< segments with fewer points are small
  /// Neighbours of each row to use, the point itself not counted; 0 = all. More cost time and do
  /// not make segments better: the normals have seen them already.
  int neighbors = 10;
  /// Pass 1: share of the points around a small segment that another one must hold to take it in.
  float neighbor_share = 0.4F;
  /// Two points farther apart than this are no neighbours: growing does not jump gaps. 0 = no
  /// limit.
  float max_gap = 2.5F;
  /// A point is refused if it lies farther than this off the tangent plane of the point that it
  /// would be reached from: the sides of a thin wall stay apart. On noisy clouds the limit is
  /// raised to what the noise asks for, to at most 0.9. 0 = no limit (the paper).
  float max_offset = 0.5F;
  /// Points of higher curvature join a segment but do not pass it on. Default: no limit.
  float max_curvature = std::numeric_limits<float>::max();
  /// Points farther than this off the tangent plane of the point that they were reached from join a
  /// segment but do not pass it on; in the cloud's unit of length. Default: no limit.
  float max_residual = std::numeric_limits<float>::max();
  /// Alpha is between the normals of a point and of its segment's seed, not of two neighbours.
  /// Faces are then the segments as they are.
  bool compare_with_seed = false;
  bool absorb_small = true;   ///< clean-up pass 1: small segments join a neighbouring segment
  bool extract_edges = true;  ///< clean-up pass 2: their points join regular ones one by one
  /// Beyond the paper, after pass 2: normals along a sharp edge are means over both faces, so a
  /// point there goes to the segment whose flat part, continued, passes nearest to it. So do the
  /// points of strips: segments without an inside, such as the row of points on an edge of a grid.
  bool settle_edges = true;
  bool connect_small = true;  ///< clean-up pass 3: small segments that touch become connected ones
  int threads = 0;            ///< see resolveThreads()
};

/// What the stages of segmentByNormals() did.
struct SegmentationReport {
  std::size_t grown = 0;      ///< segments after growing
  std::size_t small = 0;      ///< small ones among them
  std::size_t absorbed = 0;   ///< small segments that pass 1 joined with another one
  std::size_t extracted = 0;  ///< points that pass 2 moved to regular segments
  std::size_t settled = 0;    ///< points that changed their segment along sharp edges
  std::size_t regular = 0;    ///< segments of each kind at the end
  std::size_t connected = 0;
  std::size_t isolated = 0;
  std::size_t united = 0;    ///< segments that became part of another one's face
  float offset_limit = 0.F;  ///< the limit in use, in local spacings
};

/// Cuts a cloud into segments of similar normals (paper, section 2.3): region growing by alpha and
/// beta, then the three clean-up passes.
///
/// Seeds are taken flattest first (curvature, then index); growing is breadth-first; normals are
/// compared without their signs, and each accepted one is given the sign that agrees with the
/// segment. The local spacing of a point is the side of the square that it stands for, from its six
/// nearest neighbours.
///
/// \param points all rows finite where the normal is finite
/// \param normals unit normals and curvatures; points with a NaN normal get label -1, a NaN
///        curvature counts as the highest
/// \param neighborhoods of every point; rows without distances are measured anew
/// \param faces where not null: the segments once more, those united whose common border is smooth.
///        Beta keeps segments so flat that each can be seen through a plane, as triangulation and
///        the paper's orientation ask for, and cuts round faces up by it; here a cylinder is one
///        again. A border is smooth where growing could have crossed it but for beta, and the
///        surface bends there by less than alpha more than its curvature on both sides explains.
/// \return empty if the sizes of the three do not agree
Segmentation segmentByNormals(const PointView& points, const NormalView& normals,
                              const Neighborhoods& neighborhoods,
                              const SegmentationOptions& options,
                              SegmentationReport* report = nullptr, Segmentation* faces = nullptr);

}  // namespace segorient
