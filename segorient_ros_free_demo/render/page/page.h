// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "render/page/sides.h"

namespace segorient::program {

/// What the page tells of a segment.
struct PageSegment {
  float confidence = -1.F;  ///< below 0: not known
  std::string text;         ///< kind, how it was decided
};

/// A cloud for a page. What is empty is not known and cannot be switched to.
struct PageCloud {
  std::string title;
  PointView points;                       ///< not finite: left out
  std::array<double, 3> origin{0, 0, 0};  ///< is added to where points are said to be
  std::vector<float> normals;             ///< 3 a point; NaN: none
  std::vector<std::uint32_t> labels;      ///< 0xffffffff: no segment
  std::vector<PageSegment> segments;      ///< by label; may be shorter than there are labels
  std::vector<float> confidences;         ///< of points, 0 to 1; NaN: not known
  std::vector<std::uint32_t> colors;      ///< packed rgb
  std::vector<std::uint32_t> scans;       ///< 0xffffffff: none
  /// Side of each point where its sensor tells it; Open: found by how the points lie. May be empty.
  std::vector<Side> sides;
  std::vector<std::array<double, 3>> sensors;         ///< with the origin
  std::vector<std::array<double, 3>> contradictions;  ///< with the origin
};

struct PageOptions {
  std::size_t points = 1'000'000;  ///< at most so many, and 2^23; a blue-noise choice of them
  int threads = 0;                 ///< 0 = all cores; the page does not depend on it
};

/// Takes the page piece by piece.
using PageSink = std::function<void(std::string_view)>;

/// One HTML file that shows the cloud in any browser with WebGL 2, without any other file.
/// \return points that it shows
std::size_t writePage(const PageCloud& cloud, const PageOptions& options, const PageSink& sink);

}  // namespace segorient::program
