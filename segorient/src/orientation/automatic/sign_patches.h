// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/even_cells.h"

namespace segorient::detail {

/// Two patches that continue one another: the share of the surface whose neighbours across the
/// border have normals alike, less that of opposed ones.
struct PatchBorder {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float agreement = 0.F;
};

/// Small flat pieces of a surface. Segments are larger, and go on across places where three sheets
/// meet; a patch ends after so few cells that its sign is its own.
struct SignPatches {
  std::vector<std::int32_t> of;                   ///< one a cell; -1 where a piece is too small
  std::vector<std::vector<std::uint32_t>> cells;  ///< ascending
  std::vector<float> areas;                       ///< shares of the surface
  std::vector<PatchBorder> borders;               ///< ascending by (a, b), a < b

  std::size_t size() const { return cells.size(); }
};

/// Whether the surface goes on smoothly from one cell to another: normals, without sign, less than
/// 25 degrees apart, and neither cell far off the other's plane.
bool goesOn(const EvenCells& cells, std::size_t i, std::size_t q);

SignPatches growPatches(const EvenCells& cells);

/// Share of the pairs of neighbours where the surface goes on but normals are opposed.
/// \param normals 4 floats a cell; 0 is opposed to nothing
float brokenShare(const EvenCells& cells, const std::vector<float>& normals);

}  // namespace segorient::detail
