// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <array>
#include <cstdint>
#include <vector>

namespace segorient {

/// The place that most of some oriented points could have been seen from.
struct ViewpointFit {
  std::array<float, 3> position{0.F, 0.F, 0.F};
  std::int8_t facing = 1;  ///< +1 if the face that most points show to it is that of their normals
  /// Share of the points that show one and the same face to it: about 1/2 for a closed surface,
  /// near 1 for a scan from one place.
  float agreement = 0.F;
};

/// Looks for the place of the sensor from the points alone: a scan from one place shows one side of
/// every surface, so a consistent orientation turns all normals to the sensor, or all away from it.
/// Searches the bounding box, a margin around it, and far away in all directions.
///
/// \param normals 4 floats a point, oriented
/// \param rows points to use, evenly thinned to some thousand; fewer than 3 give agreement 0
ViewpointFit fitViewpoint(const PointView& points, const std::vector<float>& normals,
                          const std::vector<std::uint32_t>& rows, int threads = 0);

}  // namespace segorient
