// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::detail {

/// An even subset of an oriented cloud, with what its points stand for.
struct EvenCells {
  std::vector<float> places;   ///< 4 floats a cell: mean position
  std::vector<float> normals;  ///< 4 floats a cell: mean normal, unit; 0 where there is none
  std::vector<float> areas;    ///< one a cell, from the distances to the cells around it
  std::vector<std::uint32_t> cell_of;  ///< one a point
  Neighborhoods around;                ///< the cell itself and eight neighbours

  std::size_t size() const { return places.size() / 4; }
  PointView points() const { return {places.data(), 4, size()}; }
};

/// \param points finite, near ones side by side \param normals 4 floats a point, NaN where none
/// \param radius no two cells' first points are nearer; nothing is kept if it is not above 0
EvenCells gatherCells(const PointView& points, const std::vector<float>& normals, float radius,
                      int threads);

/// From the distances to the six nearest. \param around of the cells
float cellArea(const PointView& cells, const Neighborhoods& around, std::size_t cell);

/// The nearest cell of each point.
/// \param cells their places
std::vector<std::uint32_t> nearestCells(const PointView& points, const PointView& cells,
                                        int threads);

/// Finds what is around each of some cells, and the nearest cell of each point.
SEGORIENT_ORIENTATION_EXPORT void assignCells(const PointView& points, int threads,
                                              EvenCells& cells);

}  // namespace segorient::detail
