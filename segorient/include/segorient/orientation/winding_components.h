// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// What the winding number says of one connected component.
struct ComponentWinding {
  std::int8_t sign = 1;  ///< what turns its normals outward
  float evidence = 0.F;  ///< 0 nothing speaks for the sign, 1 everything does
  /// Mean of (w - 1/2)^2 over its points with all signs as found: near 0 for a clean closed
  /// surface, below 0.1 for a noisy one; more means open, or badly oriented.
  float residual = 0.F;
};

/// Chooses the signs of components so that the winding number of all of them together is 1/2 on the
/// surface: minimises the mean of (sum_c s_c w_c(x) - 1/2)^2 over sample points x. This knows the
/// outside, cavities, nested and linked parts. Near-linear: a component is evaluated only where it
/// is near, since the field of a closed surface vanishes outside of it.
///
/// \param points near ones side by side (CompactCloud's order)
/// \param dipoles 4 floats a point: normal times area, area; 0 where there is no normal
/// \param spacing one a point: distance below which the field is smoothed
/// \param components one a point: 0 to count - 1 by descending size, or -1
std::vector<ComponentWinding> solveComponents(const PointView& points,
                                              const std::vector<float>& dipoles,
                                              const std::vector<float>& spacing,
                                              const std::vector<std::int32_t>& components,
                                              std::size_t count, int threads = 0);

}  // namespace segorient
