// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>
#include <vector>

namespace segorient::detail {

/// Points in spherical coordinates about a place.
struct SeenFrom {
  std::vector<float> direction;  ///< 4 floats a point: of length 1; 0 for a point in that place
  std::vector<float> distance;   ///< one a point
  float depth = 0.F;             ///< from the nearest to the farthest

  std::size_t size() const { return distance.size(); }
  /// Of directions: who is beside whom, as seen from there.
  search::MedianHashIndex index(int threads) const;
};

/// \param threads see resolveThreads()
SeenFrom seeFrom(const std::array<float, 3>& place, const PointView& points, int threads);

}  // namespace segorient::detail
