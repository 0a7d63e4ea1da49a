// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tiles/place_order.h"

namespace segorient::program {

/// Cell of a point whose place is not finite.
constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

/// A point as it is in the input.
struct StoredPoint {
  std::array<double, 3> place{0, 0, 0};
  std::array<float, 3> seen_from{0, 0, 0};  ///< where points carry that, see Plan
  std::array<float, 3> normal{0, 0, 0};     ///< the same; 0 = unknown
  std::uint32_t cell = kNoCell;             ///< of the tree; not stored
};

/// What points carry beside their places.
struct PointFields {
  bool viewpoints = false;
  bool normals = false;
};

/// Points near each other in few bytes, in the order that PlaceOrder gives them.
/// \param points what is stored of them beside their places; not looked at if that is nothing
/// \param order of their places, which were added to it in the order of the points
void packPoints(const StoredPoint* points, PlaceOrder& order, const PointFields& fields,
                std::vector<std::uint8_t>& out);
/// Appends the points. \return false if the bytes are no packet of so many
bool unpackPoints(const std::vector<std::uint8_t>& packet, std::size_t count,
                  const PointFields& fields, std::vector<StoredPoint>& out);

}  // namespace segorient::program
