// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient::program {

/// Whether a point's normal points to the side that its surface shows.
enum class Side : std::uint8_t {
  Open,      ///< both sides can be seen, or none: nothing tells which is the true one
  Outer,     ///< to the side that shows by far more often; the other is seen through an opening
  Right,     ///< to the only side that shows
  Contrary,  ///< away from the side that shows more often, or from that of nearly all around
  Wrong      ///< away from the only side that shows
};

inline bool isWrong(Side side) {
  return side == Side::Contrary || side == Side::Wrong;
}
/// Whether the other side than the true one is never seen.
inline bool isClosed(Side side) {
  return side == Side::Right || side == Side::Wrong;
}

/// The side of each point, by where it can be seen from.
///
/// The points are looked at along directions spread over the sphere. How often each is seen from
/// the side that its normal points to, and how often from behind, is counted over the points of the
/// same surface around it; what hides it is found by depth, and the signs of normals play no part
/// in that. A closed surface is seen from its outside only, whatever its normals say, so that the
/// count also tells an object inside out. (Sides by visibility: Takayama et al., A simple method
/// for correcting facet orientations in polygon meshes based on ray casting, 2014.)
///
/// \param normals 3 floats a point, unit; NaN: none, the side is then Open
/// \param neighborhoods of each point, itself first
/// \param radii of discs that cover the surface, and `middle`, the middle one, as discRadii()
/// \param threads 0 = all cores; the result does not depend on it
std::vector<Side> findSides(const PointView& points, const std::vector<float>& normals,
                            const Neighborhoods& neighborhoods, const std::vector<float>& radii,
                            float middle, int threads);

}  // namespace segorient::program
