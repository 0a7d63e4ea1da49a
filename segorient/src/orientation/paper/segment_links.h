// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/segmentation/segmentation.h>

#include <cstdint>

namespace segorient {

/// The segment on the other side of a border of this one.
inline std::int32_t otherOf(const SegmentBorder& border, std::int32_t segment) {
  return segment == border.a ? border.b : border.a;
}

/// Whether a label is that of a regular segment that has points.
bool isRegular(const Segmentation& segmentation, std::int32_t label);

/// The graph that the paper's methods work on: links are borders between regular segments, which
/// touch directly or across a strip of small ones. Connected and isolated segments are not oriented
/// in themselves, so nothing is propagated through their normals; but along a sharp edge they often
/// part two faces completely, and then the pair of face points nearest to each other through the
/// strip stands for the border. Linear.
/// \return of each segment, the link to the largest neighbour first
SegmentGraph linkRegularSegments(const Segmentation& segmentation, const SegmentGraph& graph,
                                 const Neighborhoods& neighborhoods);

/// The links of one segment, as places in SegmentGraph::borders.
struct LinksOf {
  LinksOf(const SegmentGraph& links, std::int32_t segment)
      : first(links.incident.data() + links.offsets[static_cast<std::size_t>(segment)]),
        last(links.incident.data() + links.offsets[static_cast<std::size_t>(segment) + 1]) {}
  const std::uint32_t* begin() const { return first; }
  const std::uint32_t* end() const { return last; }

  const std::uint32_t* first;
  const std::uint32_t* last;
};

}  // namespace segorient
