// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/result_columns.h"

#include "support/colors.h"

namespace segorient::program {

void addNormalColumns(const std::vector<float>& normals, OutputCloud& cloud) {
  cloud.add("normal_x", normals.data(), 4);
  cloud.add("normal_y", normals.data() + 1, 4);
  cloud.add("normal_z", normals.data() + 2, 4);
  cloud.add("curvature", normals.data() + 3, 4);
}

SegmentColumns::SegmentColumns(const Segmentation& segmentation) {
  const std::size_t size = segmentation.labels.size();
  colors_.reserve(size);
  labels_.reserve(size);
  kinds_.reserve(size);
  for (const std::int32_t label : segmentation.labels) {
    labels_.push_back(label < 0 ? kNoSegment : static_cast<std::uint32_t>(label));
    colors_.push_back(segmentColor(labels_.back()));
    const auto kind = label < 0 ? SegmentKind::Isolated
                                : segmentation.segments[static_cast<std::size_t>(label)].kind;
    kinds_.push_back(static_cast<std::uint8_t>(kind));
  }
}

void SegmentColumns::addColors(OutputCloud& cloud) const {
  // The bits of an integer under the type of a float: that is how PCL stores colours.
  cloud.columns.push_back(
      {{"rgb", 'F', 4, 1, 0}, reinterpret_cast<const std::uint8_t*>(colors_.data()), 4});
}

void SegmentColumns::addLabels(OutputCloud& cloud) const {
  cloud.add("label", labels_.data());
}

void SegmentColumns::addKinds(OutputCloud& cloud) const {
  cloud.add("segment_kind", kinds_.data());
}

}  // namespace segorient::program
