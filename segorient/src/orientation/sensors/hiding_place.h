// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace segorient::detail {

/// One place for all points that cannot have seen them, as it hides about as many from itself as
/// closed bodies do from any place around them. What is there was then seen from elsewhere, too,
/// and the surface has to say where its sides are; the place can only be compared with that.
struct HidingPlace {
  KnownSensor report;
  std::vector<std::uint32_t> visible;  ///< some thousand points that it could see

  /// Whether what it could see faces it, and it may have been a sensor.
  /// \param normals 4 floats a point, as the surface has them
  bool isPlausible(const PointView& points, const std::vector<float>& normals) const;
};

/// \param place in the unit of the points
/// \return none where the place hides less
std::optional<HidingPlace> findHidingPlace(const PointView& points,
                                           const std::array<float, 3>& place, int threads);

}  // namespace segorient::detail
