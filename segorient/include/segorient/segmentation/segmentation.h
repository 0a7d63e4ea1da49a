// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace segorient {

/// What the clean-up left a segment as (paper, section 2.3, pass 3).
enum class SegmentKind : std::uint8_t {
  REGULAR,    ///< grown from a seed, large enough
  CONNECTED,  ///< small segments joined, as they occur along sharp edges
  ISOLATED,   ///< a small segment without small neighbours

  // As version 1.0 had them.
  Regular [[deprecated("REGULAR")]] = REGULAR,
  Connected [[deprecated("CONNECTED")]] = CONNECTED,
  Isolated [[deprecated("ISOLATED")]] = ISOLATED
};

/// One segment. Its points are Segmentation::members[first, first + size).
struct Segment {
  SegmentKind kind = SegmentKind::REGULAR;
  std::uint32_t first = 0;                               ///< into Segmentation::members
  std::uint32_t size = 0;                                ///< number of points
  std::array<float, 3> reference_normal{0.F, 0.F, 0.F};  ///< unit sum of its points' signed normals
  std::array<float, 3> centroid{0.F, 0.F, 0.F};          ///< mean of its points
  float area = 0.F;                                      ///< estimate from the local spacing
  float rms = 0.F;                                       ///< distance to its own best-fit plane
};

/// A cloud cut into segments that are each oriented in themselves: what segmentation hands on to
/// triangulation and orientation. Labels are ordered by descending size, equal sizes by smallest
/// member.
struct Segmentation {
  std::vector<std::int32_t> labels;  ///< per point its segment, -1 where there is no usable normal
  /// Per point +1 or -1: with this sign its normal agrees with its segment's reference normal.
  std::vector<std::int8_t> signs;
  std::vector<Segment> segments;      ///< by label
  std::vector<pcl::index_t> members;  ///< points by segment, ascending within each

  /// Iteration over one segment's points.
  const pcl::index_t* begin(std::size_t segment) const {
    return members.data() + segments[segment].first;
  }
  const pcl::index_t* end(std::size_t segment) const {
    return begin(segment) + segments[segment].size;
  }
};

/// One border between two segments: point pairs across it.
struct SegmentBorder {
  std::int32_t a = 0;       ///< smaller label
  std::int32_t b = 0;       ///< larger label
  std::uint32_t first = 0;  ///< into SegmentGraph::pairs
  std::uint32_t size = 0;   ///< number of pairs
};

/// A pair of neighbouring points of two segments.
struct BorderPair {
  pcl::index_t in_a = 0;
  pcl::index_t in_b = 0;
};

/// Which segments touch, and where. Symmetric: two points are neighbours if either is among the
/// other's neighbours.
struct SegmentGraph {
  std::vector<SegmentBorder> borders;  ///< ascending by (a, b)
  std::vector<BorderPair> pairs;       ///< by border, ascending
  /// Borders of segment s: incident[offsets[s], offsets[s + 1]).
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> incident;  ///< indices into borders
};

/// How a cloud is cut into segments, see NormalSegmentation. Angles in radians, lengths in
/// multiples of the local spacing, so nothing depends on the unit or the size of a cloud.
struct SegmentationSettings {
  float alpha = 0.3490659F;  ///< largest angle between the normals of two neighbours (20 degrees)
  float beta =
      0.5235988F;  ///< largest angle between a normal and the reference normal (30 degrees)
  float epsilon = 0.1745329F;   ///< by how much the clean-up may exceed beta (10 degrees)
  std::size_t small_size = 20;  ///< segments with fewer points are small
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
  /// Beyond the paper, at the end: segments whose common border is smooth are one face.
  /// NormalSegmentation has a setter of its own and gives both. Faces that bend by more than beta
  /// cannot be triangulated or oriented as one.
  bool unite_smooth = false;
  bool connect_small = true;  ///< clean-up pass 3: small segments that touch become connected ones
};

/// The same for a table of neighbours that is there.
struct SegmentationOptions : SegmentationSettings {
  /// Neighbours of each row to use, the point itself not counted; 0 = all. More cost time and do
  /// not make segments better: the normals have seen them already.
  int neighbors = 10;
  int threads = 0;  ///< 0 = all cores; no result depends on it
};

/// What the stages of segmentation did.
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

}  // namespace segorient
