// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <array>
#include <cstdint>
#include <vector>

namespace segorient {

/// What the clean-up left a segment as (paper, section 2.3, pass 3).
enum class SegmentKind : std::uint8_t {
  Regular,    ///< grown from a seed, large enough
  Connected,  ///< small segments joined, as they occur along sharp edges
  Isolated    ///< a small segment without small neighbours
};

/// One segment. Its points are Segmentation::members[first, first + size).
struct Segment {
  SegmentKind kind = SegmentKind::Regular;
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

/// \param k neighbours of each row to use, the point itself not counted; 0 = all
SegmentGraph buildSegmentGraph(const Segmentation& segmentation, const Neighborhoods& neighborhoods,
                               int k = 0);

}  // namespace segorient
