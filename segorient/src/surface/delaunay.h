// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace segorient {

/// A point of the plane on the integer grid; coordinates within +-kGridLimit.
struct GridPoint {
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// Differences of two coordinates then have 30 bits, and orientations are exact in 64.
constexpr std::int32_t kGridLimit = 1 << 28;

/// A triangulation in the plane with its adjacency.
struct PlanarTriangulation {
  /// Marks a missing triangle beside an edge of the hull.
  static constexpr std::uint32_t kNone = 0xffffffffU;

  struct Edge {
    std::array<std::uint32_t, 2> points;  ///< its ends
    std::array<std::uint32_t, 2>
        triangles;  ///< on both sides; kNone = outside, always the second one
  };
  struct Triangle {
    std::array<std::uint32_t, 3> points;  ///< counter-clockwise
    std::array<std::uint32_t, 3> edges;   ///< edge i joins points i and i + 1
  };

  std::vector<Edge> edges;  ///< every edge of the Delaunay triangulation, the hull's included
  std::vector<Triangle> triangles;  ///< none if all points lie in a line
  /// Points with the coordinates of an earlier one: they are in no triangle. Ascending.
  std::vector<std::uint32_t> duplicates;
};

/// Delaunay triangulation in O(n log n), by the sweep of Boost.Polygon's Voronoi diagram, which is
/// exact on integers. Points on a common circle are triangulated in one of the ways that are
/// possible.
PlanarTriangulation triangulate(const std::vector<GridPoint>& points);

}  // namespace segorient
