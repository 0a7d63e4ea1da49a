// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/piece_origins.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "orientation/sensors/sampling_law.h"

namespace segorient::detail {
namespace {

// What one side leaves beside the other to be sure of it. Sums of what a few places leave are off
// by a factor of two, as far as their deviations tell: the two of them by four.
constexpr float kOneSided = 4.F;

// The places on one side of a piece.
struct Side {
  float left = 0.F;       // of the piece's points, by all of them
  float if_facing = 0.F;  // what they would leave if the piece faced each of them
  float most = -1.F;
  std::int32_t strongest = 0;

  void add(std::int32_t place, float share, float incidence) {
    left += share;
    if_facing += share / std::max(incidence, kGrazing);
    if (share <= most) return;
    most = share;
    strongest = place;
  }
};

float distanceTo(const std::array<float, 3>& place, const DensityPatches& patches, std::size_t i) {
  const float dx = place[0] - patches.x[i];
  const float dy = place[1] - patches.y[i];
  const float dz = place[2] - patches.z[i];
  return std::sqrt(std::max(dx * dx + dy * dy + dz * dz, kNothing));
}

}  // namespace

PieceOrigins strongestPlaces(const DensityPatches& patches,
                             const std::vector<std::array<double, 3>>& places,
                             const std::vector<std::vector<float>>& rows) {
  std::vector<std::vector<float>> heights;
  heights.reserve(places.size());
  for (const std::array<double, 3>& place : places) heights.push_back(patches.heightsOver(place));
  PieceOrigins out;
  out.place.resize(patches.size());
  out.either_side.resize(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    Side behind;
    Side before;
    for (std::size_t j = 0; j < places.size(); ++j) {
      const float height = heights[j][i];
      const float incidence = std::fabs(height) / distanceTo(toFloat(places[j]), patches, i);
      (height > 0.F ? before : behind).add(static_cast<std::int32_t>(j), rows[j][i], incidence);
    }
    out.place[i] = before.left > behind.left ? before.strongest : behind.strongest;
    // Where noise exceeds the spacing, as right above a scanner, pieces lie across the surface: by
    // how much they face a place says nothing.
    const auto [less, more] = std::minmax(behind.if_facing, before.if_facing);
    out.either_side[i] = more < kOneSided * less ? 1 : 0;
  }
  return out;
}

}  // namespace segorient::detail
