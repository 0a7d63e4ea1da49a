// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segment_members.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

void collectMembers(Segmentation& segmentation) {
  std::vector<Segment>& segments = segmentation.segments;
  for (Segment& segment : segments) segment.size = 0;
  std::size_t labelled = 0;
  for (const std::int32_t label : segmentation.labels) {
    if (label < 0) continue;
    ++segments[static_cast<std::size_t>(label)].size;
    ++labelled;
  }
  std::uint32_t first = 0;
  for (Segment& segment : segments) {
    segment.first = first;
    first += segment.size;
  }
  segmentation.members.resize(labelled);
  std::vector<std::uint32_t> cursor(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) cursor[s] = segments[s].first;
  for (std::size_t i = 0; i < segmentation.labels.size(); ++i) {
    const std::int32_t label = segmentation.labels[i];
    if (label < 0) continue;
    segmentation.members[cursor[static_cast<std::size_t>(label)]++] = static_cast<pcl::index_t>(i);
  }
}

}  // namespace segorient
