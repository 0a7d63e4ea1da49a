// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace segorient {

/// What became of one place that points are said to have been seen from. Places with few points
/// each, as a moving sensor has them, are one entry together, with their mean as its position.
struct KnownSensor {
  std::array<float, 3> position{0.F, 0.F, 0.F};  ///< in input coordinates
  std::size_t points = 0;                        ///< distinct points that are said to be its own
  std::size_t seen = 0;  ///< of these, those that it could see: others were left to the surface
  bool used = true;      ///< false: it contradicts the surface, and nothing was turned to it
  bool moving = false;   ///< many places together
  /// Share of its points that lie behind others of its own, as seen from there. A sensor sees no
  /// such points: noise and stray points make up to .09 of them.
  float hidden = 0.F;
  /// Share of neighbours on one smooth sheet, its own and others', that would have to face apart.
  float contrary = 0.F;
  /// How far the density of its points falls with distance and incidence as it does from a sensor:
  /// scatter about that law over scatter about a constant. Below .7 it was there, from .9 on it was
  /// not, or the cloud was thinned; infinity where it could not be told.
  float density = std::numeric_limits<float>::infinity();
};

}  // namespace segorient
