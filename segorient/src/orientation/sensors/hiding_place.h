// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <array>
#include <cstdint>
#include <vector>

namespace segorient::detail {

/// One place for all points that cannot have seen them, as surfaces go on behind what would hide
/// them from there, see Shadows. What is there was then seen from elsewhere, too, and the surface
/// has to say where its sides are; the place can only be compared with that.
struct HidingPlace {
  KnownSensor report;
  std::vector<std::uint32_t> visible;  ///< some thousand points that it could see

  /// Whether more of what it could see faces it than turns its back to it: gaps between the points
  /// let it see some of the far side.
  /// \param normals 4 floats a point, as the surface has them
  bool isPlausible(const PointView& points, const std::vector<float>& normals) const;
};

/// \param place in the unit of the points
HidingPlace lookFrom(const PointView& points, const std::array<float, 3>& place, int threads);

}  // namespace segorient::detail
