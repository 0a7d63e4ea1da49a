// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::program {

/// A point as it is in the input.
struct StoredPoint {
  std::uint32_t number = 0;  ///< among those of its tile, in the order of the inputs
  std::array<double, 3> place{0, 0, 0};
  std::array<float, 3> seen_from{0, 0, 0};  ///< where points carry that, see Plan
  std::array<float, 3> normal{0, 0, 0};     ///< the same; 0 = unknown
  std::uint32_t cell = 0;                   ///< of the tree; not stored
};

/// What points carry beside their places.
struct PointFields {
  bool viewpoints = false;
  bool normals = false;
};

/// Points near each other in few bytes: numbers by their steps, coordinates as whole numbers of the
/// largest power of two that they are multiples of. They are exact unless that takes more than the
/// 52 bits of a double.
/// \param points ascending by number
void packPoints(const StoredPoint* points, std::size_t count, const PointFields& fields,
                std::vector<std::uint8_t>& out);
/// Appends the points. \return false if the bytes are no packet of so many
bool unpackPoints(const std::vector<std::uint8_t>& packet, std::size_t count,
                  const PointFields& fields, std::vector<StoredPoint>& out);

}  // namespace segorient::program
