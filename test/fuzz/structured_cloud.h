// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstddef>
#include <vector>

#include "byte_reader.h"

namespace segorient::test {

/// A cloud made of pieces that geometry code fails on: grids (ties), duplicates, lines, planes,
/// balls, thin walls, extreme and invalid coordinates, far away or scaled as a whole.
struct StructuredCloud {
  std::vector<float> xyz;  ///< 4 floats a point

  std::size_t size() const { return xyz.size() / 4; }
  PointView view() const { return {xyz.data(), 4, size()}; }
  void add(float x, float y, float z) { xyz.insert(xyz.end(), {x, y, z, 0.F}); }
};

/// \param most points; reading stops there or where the bytes end
StructuredCloud readCloud(ByteReader& reader, std::size_t most);

/// The rows of a cloud in another order, which `seed` decides; \return for each new row the old one
std::vector<std::size_t> shuffledRows(std::size_t size, std::uint32_t seed);

}  // namespace segorient::test
