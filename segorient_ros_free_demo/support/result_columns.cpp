// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/result_columns.h"

#include <cmath>

#include "io/file_endings.h"
#include "support/colors.h"

namespace segorient::program {
namespace {

// Columns made from a segmentation.
struct SegmentColumns {
  std::vector<std::uint32_t> colors;
  std::vector<std::uint32_t> labels;
  std::vector<std::uint8_t> kinds;

  explicit SegmentColumns(const Segmentation& segmentation) {
    const std::size_t size = segmentation.labels.size();
    colors.reserve(size);
    labels.reserve(size);
    kinds.reserve(size);
    std::vector<std::uint32_t> color_of(segmentation.segments.size());
    for (std::uint32_t s = 0; s < color_of.size(); ++s) color_of[s] = segmentColor(s);
    for (const std::int32_t label : segmentation.labels) {
      const auto s = static_cast<std::size_t>(label);
      labels.push_back(label < 0 ? kNoSegment : static_cast<std::uint32_t>(label));
      colors.push_back(label < 0 ? segmentColor(kNoSegment) : color_of[s]);
      const auto kind = label < 0 ? SegmentKind::ISOLATED : segmentation.segments[s].kind;
      kinds.push_back(static_cast<std::uint8_t>(kind));
    }
  }
};

}  // namespace

std::size_t countWithoutNormal(const std::vector<float>& normals) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < normals.size(); i += 4) count += std::isfinite(normals[i]) ? 0 : 1;
  return count;
}

void writeResults(const CloudTable& table, const Results& results, OutputFile& file) {
  OutputCloud out(table);
  const float* normals = results.normals->data();
  out.add("normal_x", normals, 4);
  out.add("normal_y", normals + 1, 4);
  out.add("normal_z", normals + 2, 4);
  out.add("curvature", normals + 3, 4);
  const SegmentColumns segments(results.segmentation != nullptr ? *results.segmentation
                                                                : Segmentation{});
  if (results.segmentation != nullptr) {
    // LAS keeps room for a camera's colours only in some of its point formats; labels do there.
    const bool las = fileEnding(file.path()) == ".las";
    if (!las && (!results.keep_colors || table.find("rgb") == nullptr)) {
      // The bits of an integer under the type of a float: that is how PCL stores colours.
      out.columns.push_back({{"rgb", 'F', 4, 1, 0},
                             reinterpret_cast<const std::uint8_t*>(segments.colors.data()),
                             4});
    }
    out.add("label", segments.labels.data());
    if (results.kinds) out.add("segment_kind", segments.kinds.data());
  }
  out.addRest(table);
  out.triangles = results.triangles;
  writeCloud(out, file);
}

}  // namespace segorient::program
