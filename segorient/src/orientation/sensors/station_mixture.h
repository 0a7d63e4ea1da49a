// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/occupancy.h"
#include "orientation/sensors/sampling_law.h"

namespace segorient::detail {

/// Places inside of the extent that mixtures are made of.
constexpr int kMixedInside = 800;

/// Places with a weight each, so that the sum of what they leave is likeliest: those that are left,
/// as most weights come to nothing.
struct Mixture {
  /// By place and piece: what it would leave where it can see, over the density that is there, as a
  /// part of the place's mean; 0 after the last piece.
  std::vector<float> rows;
  std::size_t length = 0;          ///< of a row
  std::vector<std::size_t> place;  ///< each row's, into those that were tried
  std::vector<float> weights;

  std::size_t size() const { return place.size(); }
  const float* row(std::size_t j) const { return &rows[j * length]; }
  float* row(std::size_t j) { return &rows[j * length]; }
};

/// \param law of all of them, its position unused
Mixture mixtureOf(const DensityPatches& patches, const Occupancy& occupancy,
                  const std::vector<std::array<double, 3>>& places, const Place& law, int threads);

/// Places whose mixture explains the densities, each with any weight, those near each other taken
/// together: a start for searchStations(), the heaviest first.
/// \param rays of all of them, its position unused
/// \param most of them
std::vector<std::array<double, 3>> mixturePlaces(const DensityPatches& patches,
                                                 const Occupancy& occupancy, const Extent& extent,
                                                 const Place& rays, std::size_t most, int threads);

}  // namespace segorient::detail
