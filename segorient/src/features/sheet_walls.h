// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>

#include "features/sheet_fit.h"

namespace segorient::detail {

/// Which offsets along the normal belong to the point's own wall.
struct WallSplit {
  float below = -std::numeric_limits<float>::infinity();
  float above = std::numeric_limits<float>::infinity();
  bool found = false;
};
/// \param most_apart walls farther apart than that many spacings are left to their offset alone
WallSplit splitWalls(const Offsets& offsets, const Eigen::Vector3f& normal, float most_apart);
Plane fitWithin(const Offsets& offsets, const Eigen::Vector3f& normal, const WallSplit& split);

/// Walls farther apart than that are told apart by their offset alone, and what else looks like two
/// classes at such a distance (clutter, a narrow bore) need not be walls.
constexpr float kWallsApart = 1.25F;
/// In thin clouds, where noise takes a point as far from its own wall: of walls farther apart, 32
/// neighbours hardly reach the other one.
constexpr float kThinWallsApart = 2.F;

/// A point and all its neighbours.
constexpr std::size_t kWallEntries = kSheetNeighbors + 1;

/// Points of which splitWalls() is asked at once, one a lane.
struct WallRows {
  static constexpr std::size_t kRows = 16;  ///< as many as the widest registers hold

  const float* xyz;                 ///< 4 floats a point
  const float* own[kRows];          ///< the points themselves
  const pcl::index_t* rows[kRows];  ///< kWallEntries of each
  float normal_x[kRows], normal_y[kRows], normal_z[kRows];
  float per_spacing[kRows];
  float most_apart;  ///< see splitWalls()
};
/// \return bit i: splitWalls() finds two walls at the i-th
std::uint32_t seesTwoWalls(const WallRows& of);

/// The point's own wall.
struct OwnWall {
  Plane plane;
  WallSplit split;
};
/// From a plane over all neighbours, the one over those of the point's own wall.
OwnWall fitOwnWall(const Offsets& offsets, const Plane& start, float most_apart);

}  // namespace segorient::detail
