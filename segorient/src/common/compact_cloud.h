// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/point_view.h>
#include <segorient/common/impl/fast_vector.hpp>

#include <vector>

namespace segorient {

struct Bounds;

/// The distinct finite points of a cloud but for strays beyond the reach of floats, in an order
/// that depends on where they are and not on where they stood in the input.
///
/// Every stage of the pipeline works on this. Three things follow: exact duplicates cannot fill a
/// neighbourhood, NaN points are nobody's neighbour, and the result is the same for any order of
/// the input. Points near each other in space are near each other in memory (Z-order), which is
/// what the stages after the search spend their time on.
struct CompactCloud {
  FastVector<float> xyz;             ///< 4 floats a point, the fourth is 0
  std::vector<pcl::index_t> row_of;  ///< for each input row its compact row, -1 where left out
  std::vector<pcl::index_t> source;  ///< for each compact row the first input row that holds it

  /// Input coordinates are `unit` times those of `xyz`; see normalizeUnit().
  float unit = 1.F;

  std::size_t size() const { return source.size(); }
  PointView view() const { return {xyz.data(), 4, source.size()}; }
};

/// \param points input rows; rows with NaN or infinite coordinates are left out, and those so far
///        from the bulk of the points that floats end, see Bounds::isBeyondFloats()
/// \param indices rows to use, or null for all; out of range entries are left out. With indices,
///        row_of and source refer to positions in `indices`
/// \param threads see resolveThreads()
/// \param frame of the cloud that these points are part of, which have the order that they have
///        there then; null = of the points themselves, see bulkBounds()
CompactCloud compactCloud(const PointView& points,
                          const std::vector<pcl::index_t>* indices = nullptr, int threads = 0,
                          const Bounds* frame = nullptr);

/// Divides the coordinates by the power of two that brings the cloud's extent between 1 and 2:
/// squares and cubes of them are then ordinary numbers whatever the input's units, and nothing is
/// rounded.
void normalizeUnit(CompactCloud& cloud);

}  // namespace segorient
