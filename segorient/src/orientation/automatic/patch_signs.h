// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>

#include <vector>

#include "orientation/automatic/even_cells.h"
#include "orientation/automatic/orient_points.h"

namespace segorient::detail {

/// An even subset of a cloud, and how the points around each cell are to be turned.
struct CellSigns {
  EvenCells cells;
  std::vector<float> signs;  ///< one a cell, -1 to 1; empty where points are to stay as they are

  bool empty() const { return signs.empty(); }
};

/// Where bodies touch or overlap, borders of segments lead astray: three sheets meet, each pair
/// agrees on a side, and all three cannot. The winding number knows better.
///
/// On an even subset, small flat patches p get signs s_p between -1 and 1 that minimise
///
///   E(s) = sum over places x of a_x (sum over p of s_p w_p(x) - t_x)^2
///        + sum over borders (p, q) of c_pq (s_p -+ s_q)^2
///
/// with a_x the area of x as a share of all, w_p the winding number of patch p, t_x = 1/2 (between
/// the outside, 0, and the inside, 1), and c_pq how far p and q continue one another. That is
/// convex: from nothing there is one solution. Faces in contact, with the inside on both sides, get
/// signs near 0 and are left out of more rounds. Of these solutions and of the normals as they are,
/// the best by whole signs is taken if it is clearly better.
///
/// Nothing is found where the winding number is that of a closed surface already, nor of open
/// ground.
///
/// \param points finite, near ones side by side \param normals 4 floats a point, oriented
/// \param spacing of the points, median \param orientation that they have
/// \param noisy whether noise leaves few neighbours no say: cells are larger then, if they have to
SEGORIENT_ORIENTATION_EXPORT CellSigns findCellSigns(const PointView& points,
                                                     const std::vector<float>& normals,
                                                     float spacing,
                                                     const AutoOrientation& orientation, bool noisy,
                                                     int threads);

/// Whether seeds, or else directions, agree less with these signs than with the normals as they
/// are. \param normals of the points, turned for the field (turnInsideOut()) \param components of
/// the points \param inside_out which of them were turned for it
SEGORIENT_ORIENTATION_EXPORT bool contradictHints(const PointView& points, const CellSigns& cells,
                                                  const std::vector<float>& normals,
                                                  const std::vector<std::int32_t>& components,
                                                  const std::vector<std::uint8_t>& inside_out,
                                                  const PointHints& hints);

/// Each point takes the sign of the nearest cell whose normal is alike.
/// \param points those that the cells are about, see EvenCells::cell_of
/// \param found normals and their confidences may change
SEGORIENT_ORIENTATION_EXPORT void takeCellSigns(const PointView& points, const CellSigns& cells,
                                                AutoNormals& found);

}  // namespace segorient::detail
