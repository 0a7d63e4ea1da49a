// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
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

/// A surface that is seen at a smaller cosine rises by many spacings, and ends nowhere for sure.
constexpr float kLeastIncidence = 0.15F;
/// Points of a surface, at least: a single one may be a stray.
constexpr std::size_t kNoStray = 2;

/// The least step of depth that lies between two surfaces: some spacings along the farther one, and
/// more than the steps of depth cameras, and their noise.
/// \param spacing of that surface, seen at the cosine `incidence`
/// \param depth of what is seen: noise of what is far away does not grow with the distance
inline float depthStep(float spacing, float incidence, float distance, float depth) {
  // Noise, and the steps of depth cameras.
  constexpr float kSpacings = 4.F;
  constexpr float kOfDistance = 0.03F;
  return std::max(kSpacings * spacing / std::max(incidence, kLeastIncidence),
                  kOfDistance * std::min(distance, depth));
}

/// \param threads see resolveThreads()
SeenFrom seeFrom(const std::array<float, 3>& place, const PointView& points, int threads);

}  // namespace segorient::detail
