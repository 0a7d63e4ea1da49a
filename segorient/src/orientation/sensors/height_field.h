// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include "orientation/sensors/density_patches.h"

namespace segorient::detail {

/// Height over width of land, at most: what a camera sees is about as deep as it is wide.
constexpr float kMostRelief = 0.3F;
/// Width of a column, in spacings: it holds about nine points of what was seen from above.
constexpr float kColumn = 3.F;

/// How far a cloud is one surface over the xy plane, as aircraft and drones see the ground.
struct HeightField {
  float relief = 0.F;   ///< height over the diagonal of the ground, of the middle 96 per cent
  float filled = 0.F;   ///< share of the columns that have some points and not just one or two
  float layered = 1.F;  ///< share of those that have two layers far apart, as their neighbours do
  float inner = 0.F;    ///< share of columns that have others on all sides
  float upright = 1.F;  ///< share of points in columns that hold far more than others, as of walls
  float backed = 1.F;   ///< share of flat pieces with another layer close behind or before them

  /// Whether nearly all of it is one surface that faces up. An open sheet looks the same: that a
  /// sensor has seen it, uneven densities have to say.
  bool sure() const;
};

/// Whether a camera at a place below a cloud that looks along +z sees the cloud's middle, 45
/// degrees off its axis at most.
bool looksUpAt(const std::array<float, 3>& place, const std::array<float, 3>& middle);

/// Which points nothing is above, so that what sees the ground from there saw them, too: not those
/// of undersides and steep sides.
/// \param spacing of the points
SEGORIENT_ORIENTATION_EXPORT std::vector<std::uint8_t> openToTheSky(const PointView& points,
                                                                    float spacing);

/// How high the points lie over the median height of the ground in their column; those that have
/// none there are left out.
/// \param side of a column
std::vector<float> heightsOver(const PointView& ground, const PointView& points, float side);

/// \param index of the points
/// \param patches of the points
/// \param all that there is, the points among it: columns that hold some of it are filled
HeightField measureHeightField(const PointView& points, const search::MedianHashIndex& index,
                               const DensityPatches& patches, const PointView& all);

}  // namespace segorient::detail
