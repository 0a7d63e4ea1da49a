// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstdint>
#include <vector>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/piece_origins.h"

namespace segorient::detail {

/// A cloud in the frame of a scene, and the index on the same points in the cloud's own one.
struct FramedPoints {
  PointView points;
  PointView own;
  const search::MedianHashIndex& index;
};

/// Where points were seen from.
struct PointPlaces {
  std::vector<std::int32_t> place;        ///< -1 = there is no telling
  std::vector<std::uint8_t> either_side;  ///< as PieceOrigins has it
};

/// What the nearest piece of surface says, or one in whose plane the point lies. Of a thin wall
/// with a room on either side there may be no piece, and those around it were seen from both rooms:
/// a point that lies in the plane of none of them has no place if those of the pieces are not on
/// one side of its own plane. \param places those that `origins` is about
PointPlaces placesOfPoints(const FramedPoints& cloud, const DensityPatches& patches,
                           const PieceOrigins& origins,
                           const std::vector<std::array<float, 3>>& places, int threads);

}  // namespace segorient::detail
