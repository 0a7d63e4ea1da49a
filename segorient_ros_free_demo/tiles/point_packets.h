// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tiles/place_order.h"

namespace segorient::program {

/// A point as it is in the input.
struct StoredPoint {
  std::array<double, 3> place{0, 0, 0};
  std::array<float, 3> seen_from{0, 0, 0};  ///< where points carry that, see Plan
  std::array<float, 3> normal{0, 0, 0};     ///< the same; 0 = unknown
  std::uint32_t number = 0;                 ///< of its row among those of a chunk; not stored
  std::uint32_t cell = 0;                   ///< of the tree; not stored
};

/// What points carry beside their places.
struct PointFields {
  bool viewpoints = false;
  bool normals = false;
};

/// Points near each other in few bytes, in the order that PlaceOrder gives them.
/// \param order of their places, which were added to it in the order of the points
void packPoints(const StoredPoint* points, PlaceOrder& order, const PointFields& fields,
                std::vector<std::uint8_t>& out);
/// Appends the points. \return false if the bytes are no packet of so many
bool unpackPoints(const std::vector<std::uint8_t>& packet, std::size_t count,
                  const PointFields& fields, std::vector<StoredPoint>& out);

}  // namespace segorient::program
