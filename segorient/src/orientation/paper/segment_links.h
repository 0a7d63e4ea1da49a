// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/segmentation/segmentation.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// Two regular segments that touch, directly or across a strip of small segments.
struct SegmentLink {
  std::int32_t a = 0;       ///< smaller label
  std::int32_t b = 0;       ///< larger label
  std::uint32_t first = 0;  ///< into SegmentLinks::pairs
  std::uint32_t size = 0;   ///< number of pairs
  bool bridged = false;     ///< no points of the two are neighbours themselves

  std::int32_t other(std::int32_t segment) const { return segment == a ? b : a; }
};

/// The graph that the paper's methods work on: regular segments only. Connected and isolated
/// segments are not oriented in themselves, so nothing is propagated through their normals; but
/// along a sharp edge they often part two faces completely, and then the pair of face points
/// nearest to each other through the strip stands for the border.
struct SegmentLinks {
  std::vector<SegmentLink> links;      ///< ascending by (a, b)
  std::vector<BorderPair> pairs;       ///< by link
  std::vector<std::uint32_t> offsets;  ///< links of segment s: incident[offsets[s], offsets[s + 1])
  /// Indices into links; of each segment, the one to the largest neighbour first.
  std::vector<std::uint32_t> incident;
};

/// Whether a label is that of a regular segment that has points.
bool isRegular(const Segmentation& segmentation, std::int32_t label);

/// \param k neighbours of each row to bridge over, the point itself not counted; 0 = all. Linear.
SegmentLinks linkRegularSegments(const Segmentation& segmentation, const SegmentGraph& graph,
                                 const Neighborhoods& neighborhoods, int k = 0);

}  // namespace segorient
