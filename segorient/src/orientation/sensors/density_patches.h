// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/box.h"

namespace segorient::detail {

/// Flat pieces of a cloud's surface with the density of the points on them: what tells where a
/// sensor stood. Row i is one piece; a piece is a point's neighbourhood.
struct DensityPatches {
  std::vector<float> x, y, z;      ///< centre
  std::vector<float> nx, ny, nz;   ///< unit normal, of either sign
  std::vector<float> log_density;  ///< of points per area *in* the surface
  std::vector<float> sparsity;     ///< median density over density
  int k = 0;                       ///< neighbours that each was made of
  float flat = 0.F;                ///< share of the neighbourhoods that were flat
  float spacing = 0.F;             ///< median distance to the sixth neighbour
  float reach = 0.F;               ///< 85th percentile of the distance to the sixth neighbour
  bool tell_laws = false;          ///< there are enough independent ones to fit a law to

  std::size_t size() const { return x.size(); }

  /// Appends a piece, without its sparsity.
  void add(const float* center, const float* normal, float density);

  /// How far a point is in front of a piece's plane; below 0 behind it.
  float heightOf(const float* point, std::size_t piece) const {
    return (point[0] - x[piece]) * nx[piece] + (point[1] - y[piece]) * ny[piece] +
           (point[2] - z[piece]) * nz[piece];
  }

  /// The same of a place over each of them.
  std::vector<float> heightsOver(const std::array<double, 3>& place) const;

  /// A place's image across the plane of the nearest piece.
  std::array<double, 3> imageOf(const std::array<double, 3>& place) const;

  /// Whether most of the pieces lie in planes that hold a tenth of all, and these in more than one
  /// direction: as in rooms, unlike on what was turned on a lathe.
  bool haveWalls() const;

  /// Of the centres.
  search::MedianHashIndex index(int threads) const;

  /// Fills `sparsity` from `log_density`.
  void setSparsity();

  /// Every m-th piece: `count` of them, at most twice as many.
  DensityPatches thinned(std::size_t count) const;
};

/// \param points in an order that depends on where they are (CompactCloud), so that every m-th is
///        a fair sample that is the same for any order of the input
/// \param index of `points`
/// \return of few flat neighbourhoods, those of the fewest points, which tell no law
DensityPatches densityPatches(const PointView& points, const search::MedianHashIndex& index,
                              int threads);

/// What the mean deviation of log density from its median is where points fall at random with the
/// same density everywhere: counts of k vary by their root.
float chanceDeviation(int k);

/// Whether points of these variances, ascending, have a density on a surface: they are flat, unlike
/// at edges and in noise as deep as they spread, and no single ring or scan line.
template <typename Real>
bool isPieceOfSurface(Real least, Real middle, Real most) {
  // Noise as deep as a ninth of the radius, and lines three and a half times as far apart as the
  // points on them, are as much.
  constexpr auto kFlat = static_cast<Real>(0.05);
  constexpr auto kWide = static_cast<Real>(0.08);
  return least < kFlat * middle && middle > kWide * most;
}

/// What lies farther from the median is another surface's density, or no surface: a factor of 4.5.
constexpr float kDeviationCut = 1.5F;

/// The least and the largest of some values, but for `cut` at either end.
std::pair<float, float> rangeWithout(std::size_t cut, std::vector<float> values);

/// The box around a sample of about so many points, but for one `part` of them at either end of
/// each axis.
Box boxWithout(std::size_t part, const PointView& points, std::size_t sample);

/// Mean over the values of |value - median|, cut off at kDeviationCut.
float deviation(const std::vector<float>& values);

}  // namespace segorient::detail
