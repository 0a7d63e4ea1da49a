// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// Points of a component, at least, that the winding number is sampled at: the mean of so many is
/// known to a tenth (its scatter is at most one half). Fewer say too little.
constexpr std::size_t kLeastSamples = 24;

/// What the winding number says of one connected component.
struct ComponentWinding {
  std::int8_t sign = 1;  ///< what turns its normals outward
  float evidence = 0.F;  ///< 0 nothing speaks for the sign, 1 everything does
  /// Mean of (w - 1/2)^2 over its points with all signs as found: near 0 for a clean closed
  /// surface, below 0.1 for a noisy one; more means open, or badly oriented.
  float residual = 0.F;
  /// By how much that would grow with the other sign, of this component alone.
  float gain = 0.F;
};

/// Chooses the signs of components so that the winding number of all of them together is 1/2 on the
/// surface: minimises the mean of (sum_c s_c w_c(x) - 1/2)^2 over sample points x. This knows the
/// outside, cavities, nested and linked parts. One by one, the largest first, and then all over
/// again by TurnRule: the first ones did not know of those around them. Near-linear: a component is
/// evaluated only where it is near, since the field of a closed surface vanishes outside of it.
///
/// \param points near ones side by side (CompactCloud's order)
/// \param dipoles 4 floats a point: normal times area, area; 0 where there is no normal
/// \param spacing one a point: distance below which the field is smoothed
/// \param components one a point: 0 to count - 1 by descending size, or -1
std::vector<ComponentWinding> solveComponents(const PointView& points, const float* dipoles,
                                              const float* spacing,
                                              const std::vector<std::int32_t>& components,
                                              std::size_t count, int threads = 0);

/// When turnParts() turns a part over. It also does where less is gained, as others around are
/// still wrong, if the part's own mean square falls from above .3 to .08 or less (or to
/// `residual`, if that is less).
struct TurnRule {
  double gain = 1.0 / 3.0;  ///< the sum of squares around the part falls by more than this share
  /// And at its own points the mean square is no more than this then, or was 1 or more before: that
  /// is what a closed surface has that is alone and inside out, whatever it stands on.
  double residual = 0.2;
};

/// Turns over single parts where that brings the winding number much nearer to 1/2, in the
/// order of what they gain at first. At the points of a sheet that is all alone, (w - 1/2)^2 is
/// 1/4: a limit below that leaves open surfaces as they are, and so does that their sum hardly
/// falls.
///
/// \param dipoles as above, of normals that point outward as far as known
/// \param parts one a point: 0 to count - 1, or -1
/// \param fixed the first so many parts stay as they are
/// \return one a part: -1 for those to be turned over, 1 for all others
std::vector<std::int8_t> turnParts(const PointView& points, const float* dipoles,
                                   const float* spacing, const std::vector<std::int32_t>& parts,
                                   std::size_t count, std::size_t fixed, const TurnRule& rule = {},
                                   int threads = 0);

}  // namespace segorient
