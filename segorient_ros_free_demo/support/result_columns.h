// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/segmentation/segmentation.h>

#include <cstdint>
#include <vector>

#include "io/cloud_writer.h"

namespace segorient::program {

/// Appends normal_x, normal_y, normal_z, curvature.
/// \param normals 4 floats a point
void addNormalColumns(const std::vector<float>& normals, OutputCloud& cloud);

/// Columns made from a segmentation: colours, labels, kinds.
class SegmentColumns {
 public:
  explicit SegmentColumns(const Segmentation& segmentation);
  void addColors(OutputCloud& cloud) const;  ///< rgb
  void addLabels(OutputCloud& cloud) const;  ///< label; 4294967295 where there is none
  void addKinds(OutputCloud& cloud) const;   ///< segment_kind: 0 regular, 1 connected, 2 isolated

 private:
  std::vector<std::uint32_t> colors_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint8_t> kinds_;
};

}  // namespace segorient::program
