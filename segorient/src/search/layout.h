// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// How the points of a MedianHashIndex lie in memory.
#pragma once

#include <pcl/types.h>
#include <segorient/common/impl/fast_vector.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::search {

/// Tight box around points.
struct Box {
  float lo[3];
  float hi[3];
};

/// A leaf of the median subdivision: up to some thousand points, hashed into the cells of a grid.
/// Cell (x, y, z) has the number x + counts[0] * (y + counts[1] * z), so that the points of cells
/// next to each other in x are one range.
struct Region {
  std::uint32_t begin, end;   ///< its points
  std::uint32_t first_start;  ///< where its cells begin in Layout::starts
  std::uint16_t counts[3];    ///< cells along each axis
  std::uint16_t flat;         ///< 1 in or below a flat node, see Layout::flat
  float inverse_edge;         ///< 1 / edge length of a cell
  float spacing16;            ///< squared distance from a point to its 16th neighbour, typically
};

/// Inner node of the median subdivision: points with a smaller coordinate are on the left, those
/// with a larger one on the right, equal ones on either side.
struct Split {
  float value;
  std::uint32_t axis;
};

/// The points by region and cell, and the tree over the regions. The tree is complete: node i has
/// the children 2 i and 2 i + 1, the root is 1, and region r is node regions.size() + r.
struct Layout {
  /// Vectors are read beyond the last point by up to this many entries: two of the longest.
  static constexpr std::size_t kPadding = 32;

  FastVector<float> x, y, z;          ///< padded
  FastVector<std::uint32_t> id;       ///< index that is reported; padded
  FastVector<std::uint32_t> row;      ///< row that was given to build(); empty where row = id
  std::vector<Region> regions;        ///< a power of two of them, or none
  std::vector<Box> boxes;             ///< by node; the first is unused
  std::vector<Split> splits;          ///< by inner node; the first is unused
  std::vector<std::uint16_t> starts;  ///< per region and cell: first point, counted from begin

  /// A node is flat if all squared distances within it are 0: many points in one place, or so near
  /// each other that squares vanish. 1 at the topmost flat nodes; empty where there are none. Then
  /// flat_id has the ids of each such node in ascending order, where its points are.
  std::vector<std::uint8_t> flat;
  FastVector<std::uint32_t> flat_id;

  std::size_t size() const { return x.empty() ? 0 : x.size() - kPadding; }
  std::size_t memory() const {
    return (x.capacity() + y.capacity() + z.capacity()) * sizeof(float) +
           (id.capacity() + row.capacity()) * sizeof(std::uint32_t) +
           regions.capacity() * sizeof(Region) + boxes.capacity() * sizeof(Box) +
           splits.capacity() * sizeof(Split) + starts.capacity() * sizeof(std::uint16_t) +
           flat.capacity() + flat_id.capacity() * sizeof(std::uint32_t);
  }
};

/// A finite point on its way into the layout.
struct BuildPoint {
  float xyz[3];
  std::uint32_t row;
};

/// Sorts points into a layout.
/// \param points used up
/// \param region_size most points in a region; from 1 to kMostRegionSize
/// \param indices if not null, indices[row] is reported instead of row
/// \param threads at least 1; the layout does not depend on it
Layout buildLayout(BuildPoint* points, std::size_t count, std::size_t region_size,
                   const std::vector<pcl::index_t>* indices, int threads);

/// The median subdivision of a layout: regions, boxes and splits.
/// \param other room for as many points
/// \return the points region by region, in one of the two arrays
BuildPoint* subdivide(BuildPoint* points, BuildPoint* other, std::size_t count, std::size_t levels,
                      int threads, Layout& layout);

/// So that starts fit 16 bits.
constexpr std::size_t kMostRegionSize = 32768;

}  // namespace segorient::search
