// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "orientation/sensors/density_patches.h"

namespace segorient::detail {

inline std::array<float, 3> toFloat(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// A density so low that it is none, whose logarithm and inverse are numbers.
constexpr float kNothing = 1e-30F;

/// Cosine of the incidence from which on a normal's own noise decides: 88 degrees.
constexpr float kGrazing = 0.03F;

/// How a device spreads its rays. Points per area of a surface seen under the angle c from its
/// normal at distance d are cos(c) / d^2 times the rays per solid angle, which are:
enum class SamplingLaw : std::uint8_t {
  SOLID_ANGLE,  ///< the same in all directions
  ANGLE_GRID,   ///< 1 / cos(elevation): equal steps of azimuth and elevation about an axis
  PINHOLE       ///< 1 / cos^3 of the angle from the optical axis: equal steps in an image
};

/// Of a device that looks down as far as up.
constexpr float kNoLowest = -2.F;

/// A sensor that might have been: where it stood, and its axis (see SamplingLaw).
struct Place {
  std::array<double, 3> position{0.0, 0.0, 0.0};
  std::array<double, 3> axis{0.0, 0.0, 1.0};  ///< unit; unused by SOLID_ANGLE
  SamplingLaw law = SamplingLaw::SOLID_ANGLE;
  float lowest = kNoLowest;  ///< sine of the lowest elevation about the axis that an ANGLE_GRID has
};

/// What the law leaves of each piece's log density, up to a common constant.
void residuals(const DensityPatches& patches, const Place& place, std::vector<float>& out);

/// What the law leaves on each piece over the density that is there, up to a common constant: what
/// several sensors leave is the sum of these.
void ratios(const DensityPatches& patches, const Place& place, std::vector<float>& out);

/// Natural logarithms of positive numbers to 1e-5, in place.
void takeLogs(std::vector<float>& values);

/// deviation() of the residuals. \param scratch of the caller, so that loops do not allocate
float costOf(const DensityPatches& patches, const Place& place, std::vector<float>& scratch);

/// The mean direction from the place to the pieces: where a camera there would have looked.
std::array<double, 3> meanView(const DensityPatches& patches, const std::array<double, 3>& from);

/// Moves a place and, where its law has one, its axis to the least cost nearby.
/// \param step of the position at first; 0 = the position is known, only the axis is sought
/// \param free_axis otherwise ANGLE_GRID keeps its axis and PINHOLE takes meanView()
float refinePlace(const DensityPatches& patches, double step, bool free_axis, int evaluations,
                  Place& place);

}  // namespace segorient::detail
