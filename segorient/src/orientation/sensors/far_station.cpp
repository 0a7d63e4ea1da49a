// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/far_station.h"

#include <cstddef>

#include "common/in_double.h"

namespace segorient::detail {
namespace {

// Of costs: some 60 cameras, stations and range scanners leave 1.4 to 45 times as much across,
// parallel rays 1.0 to 1.21 times.
constexpr float kAlike = 1.3F;
// Of the pieces: two places see opposite sides of them, or the same.
constexpr float kNearlyAll = 0.9F;

FittedPlace acrossFrom(const std::array<double, 3>& middle, const FittedPlace& found) {
  FittedPlace out = found;
  for (std::size_t a = 0; a < 3; ++a) {
    out.place.position[a] = 2.0 * middle[a] - found.place.position[a];
  }
  return out;
}

float shareTurned(const DensityPatches& patches, const FittedPlace& a, const FittedPlace& b) {
  return static_cast<float>(countTurned(patches, a, b)) / static_cast<float>(patches.size());
}

}  // namespace

std::optional<FittedPlace> sideOfFarPlace(const DensityPatches& patches, const FittedPlace& found,
                                          bool is_even,
                                          const std::vector<std::array<float, 3>>& suggestions) {
  const Extent extent = extentOf(patches);
  if (extent.holds(found.place.position, kFarthest * extent.diagonal())) return found;
  const FittedPlace mirrored = acrossFrom(extent.middle(), found);
  if (shareTurned(patches, found, mirrored) < kNearlyAll) return found;
  const FittedPlace across = fitBeside(patches, mirrored);
  if (!is_even && across.cost > kAlike * found.cost) return found;
  for (const std::array<float, 3>& s : suggestions) {
    if (!isFinite(s.data())) continue;
    FittedPlace place = found;
    place.place.position = inDouble(s.data());
    // Near to an object is where its own coordinates begin, far from it where those of a map do.
    if (extent.holds(place.place.position, extent.diagonal())) continue;
    if (!extent.holds(place.place.position, kFarthest * extent.diagonal())) continue;
    const float turned = shareTurned(patches, found, place);
    if (turned > kNearlyAll) return across;
    if (turned < 1.F - kNearlyAll) return found;
  }
  return std::nullopt;
}

}  // namespace segorient::detail
