// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "orientation/sensors/sampling_law.h"

namespace segorient::detail {

/// What a law may leave of the constant's deviation at the best of all places: true ones .04 to
/// .31, solids and sheets .99 and more, several stations around an object from .42 on.
constexpr float kSureFound = 0.33F;
/// Of the constant's cost: stations that gain less than this are not there.
constexpr float kGain = 0.035F;
/// A place that somebody names is kept unless another one explains this much more.
constexpr float kMuchBetter = 0.6F;
/// Costs this much apart are the same: as far as searches from different starts come.
constexpr float kSameCost = 1.05F;

/// A place and how far the densities deviate from its law.
struct FittedPlace {
  Place place;
  float cost = 0.F;
};

/// One known position: the law, and its axis, that fit best there.
FittedPlace fitAt(const DensityPatches& patches, const std::array<double, 3>& position);

/// The place of least cost near another one.
FittedPlace fitBeside(const DensityPatches& patches, const FittedPlace& place);

/// Of how many pieces two places see opposite sides.
std::size_t countTurned(const DensityPatches& patches, const FittedPlace& a, const FittedPlace& b);

/// The best place anywhere around and inside the cloud; nothing where all of a coarse choice are
/// much worse than no sensor. \param constant deviation() of the log densities
std::optional<FittedPlace> searchStation(const DensityPatches& patches, float constant,
                                         int threads);

/// Where the middle 98 per cent of the pieces are, along each axis.
struct Extent {
  std::array<double, 3> low{0.0, 0.0, 0.0};
  std::array<double, 3> high{0.0, 0.0, 0.0};

  double diagonal() const;
  std::array<double, 3> middle() const;
  /// Whether a place is in there, or less than a margin beside it.
  bool holds(const std::array<double, 3>& place, double margin) const;
};
double distance(const std::array<double, 3>& a, const std::array<double, 3>& b);
Extent extentOf(const DensityPatches& patches);

/// Places in a regular grid inside the extent, `count` or a few more.
std::vector<std::array<double, 3>> placesInside(const Extent& extent, int count);

/// Places on shells around the extent.
std::vector<std::array<double, 3>> placesOutside(const Extent& extent);

/// Both.
std::vector<std::array<double, 3>> placesAround(const Extent& extent, int inside);

}  // namespace segorient::detail
