// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// A pair of points of two segments, a being the smaller label.
struct LabelledPair {
  std::int32_t a;
  std::int32_t b;
  BorderPair pair;
};

inline LabelledPair labelled(std::int32_t one, pcl::index_t in_one, std::int32_t other,
                             pcl::index_t in_other) {
  if (one < other) return {one, other, {in_one, in_other}};
  return {other, one, {in_other, in_one}};
}

/// Adds the borders that some pairs make to a graph, each pair once; not to SegmentGraph::incident.
/// \param pairs ascending by labels and points, of borders that the graph does not have yet
SEGORIENT_SEGMENTATION_EXPORT void appendBorders(const std::vector<LabelledPair>& pairs,
                                                 SegmentGraph& graph);

/// Lists the borders of each segment anew, ascending.
SEGORIENT_SEGMENTATION_EXPORT void listIncident(std::size_t segments, SegmentGraph& graph);

/// Which segments touch: two points are neighbours if either is among the other's.
/// \param k neighbours of each row to use, the point itself not counted; 0 = all
SEGORIENT_SEGMENTATION_EXPORT SegmentGraph buildSegmentGraph(const Segmentation& segmentation,
                                                             const Neighborhoods& neighborhoods,
                                                             int k = 0);

}  // namespace segorient
