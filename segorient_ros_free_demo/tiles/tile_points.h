// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tiles/plan.h"
#include "tiles/tile_records.h"
#include "tiles/tile_share.h"

namespace segorient::program {

/// Points that a tile and one of its neighbours both have: those of one of the two that are in the
/// halo of the other, by the number that they have here, as their tile's file has them. The
/// neighbour finds the same ones.
struct SharedPoints {
  std::uint32_t other = 0;  ///< the neighbour
  std::uint32_t owner = 0;  ///< which of the two they belong to
  std::vector<std::uint32_t> points;
};

/// A tile's own points, and those of others in its halo: by the tile that owns them, and as its
/// file has them.
struct TilePoints {
  std::vector<OutputStart> starts;  ///< of outputs, among its own points
  std::vector<float> xyz;           ///< 3 each, relative to the tile's origin
  std::vector<TileRole> roles;
  std::vector<float> whole;          ///< see workOnTile()
  std::vector<float> viewpoints;     ///< 3 each, relative to the plan's origin; or empty
  std::vector<float> normals;        ///< 3 each, see Plan::hasNormals(), 0 = none; or empty
  std::vector<SharedPoints> shared;  ///< ascending by the neighbour, then by the owner
};

/// Reads them from the files of points.
TilePoints readTilePoints(const Plan& plan, const std::string& folder, std::uint32_t tile);

}  // namespace segorient::program
