// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient::detail {

/// Energies of solutions that are equally good differ by less than a tenth, as other points count.
constexpr float kClearlyLess = 0.9F;
/// Share of pairs of neighbours that face each other from which on a patch of some ten points may
/// be the wrong way: with fewer, nothing contradicts itself.
constexpr float kSuspicious = 0.0001F;

/// Neighbours whose normals are opposed: means over all pairs of how far they are.
struct OpposedPairs {
  /// Pairs that face each other. The two sides of a wall have their backs to each other, and a gap
  /// between two surfaces that is narrower than the spacing is nothing that points could tell from
  /// one surface: where points face each other, somebody is wrong.
  float facing = 0.F;
  float backs = 0.F;  ///< pairs with their backs to each other: thin walls
};

/// Of some ten thousand points at most. \param normals 4 floats a point, NaN where none
SEGORIENT_ORIENTATION_EXPORT OpposedPairs opposedPairs(const PointView& points,
                                                       const Neighborhoods& neighborhoods,
                                                       const std::vector<float>& normals,
                                                       int threads);

/// What speaks against a solution for the signs, whatever way and scale it came from.
struct SignEnergy {
  /// Mean over the surface of min(|w|, 1/2), w the winding number in front of a point: nothing in
  /// front of a closed surface, and of an open one no more than a half. What lies *behind* a point
  /// is not asked: behind the wall of a thin plate is the outside again.
  float outside = 0.F;
  OpposedPairs pairs;

  /// In terms of a share of the surface: a point that is on the wrong side of a sheet meets some
  /// three of those that are right among its eight neighbours.
  float total() const { return outside + 3.F * pairs.facing; }
};

/// Judges solutions of one cloud. The winding number is that of all points; where sheets overlap,
/// as scans of one object do, the area of each cell of an even subset is shared by its points, so
/// that the surface counts once.
class SignJudge {
 public:
  /// \param points finite, near ones side by side; must outlive this, as must `neighborhoods`
  SignJudge(const PointView& points, const Neighborhoods& neighborhoods, int threads);

  /// \param normals 4 floats a point: oriented unit normal; NaN where none
  SignEnergy judge(const std::vector<float>& normals) const;
  /// SignEnergy::outside of these points, by some thousand of them; 0 of none.
  float outsideAt(const std::vector<std::uint32_t>& rows, const std::vector<float>& normals) const;

 private:
  PointView points_;
  const Neighborhoods& neighborhoods_;
  int threads_;
  float sixth_ = 0.F;                // median distance to the sixth neighbour
  std::vector<float> areas_;         // of each point
  std::vector<std::uint32_t> even_;  // an even subset
};

}  // namespace segorient::detail
