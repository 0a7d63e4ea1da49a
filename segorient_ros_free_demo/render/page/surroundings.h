// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <vector>

#include "render/page/page.h"

namespace segorient::program {

/// The plane of a neighbour across an edge: a disc ends there.
struct DiscEnd {
  std::array<float, 3> direction{};  ///< out of the disc; 0: does not end
  float distance = 0.F;              ///< from its middle, of its radius
};

/// What the points shown tell of each other.
struct Surroundings {
  static constexpr std::size_t kEnds = 2;  ///< of a disc: it may lie in a corner

  double radius = 0.0;                           ///< the middle one of discs
  std::vector<float> sizes;                      ///< of each disc, of the middle radius
  std::vector<std::array<DiscEnd, kEnds>> ends;  ///< empty without normals
  std::vector<Side> sides;                       ///< empty without normals

  /// \param rows of the points shown
  Surroundings(const PageCloud& cloud, const std::vector<std::uint32_t>& rows, int threads);
};

}  // namespace segorient::program
