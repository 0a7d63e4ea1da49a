// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// Oriented points, for the fields below. All must outlive this.
struct DipoleCloud {
  PointView points;                                  ///< finite, near ones side by side
  const std::vector<float>& dipoles;                 ///< 4 floats a point: normal times area, area
  const std::vector<std::uint32_t>* rows = nullptr;  ///< points to use, ascending; null = all
};

/// The dipoles of points, 0 where there is no normal. \param normals 4 floats a point
/// \param areas one a point
std::vector<float> dipolesOf(const std::vector<float>& normals, const std::vector<float>& areas);

/// Fields of oriented points that are smeared over a radius, at many places at once: with d = p - x
/// and s = d^2 + r^2, sums over all points p. Places that lie near each other in memory share the
/// list of what they see, where far points stand together as one (Barnes, Hut 1986).
///
/// \param at places, near ones side by side \param radius above 0
/// \param threads see resolveThreads(); results do not depend on it

/// The winding number, sum m.d / (4 pi s^(3/2)), m the dipole. \return one a place
std::vector<float> windingNumbers(const PointView& at, const DipoleCloud& from, float radius,
                                  int threads);

/// Minus its gradient, see steepestDescent(). \return 4 floats a place, the last is 0
std::vector<float> steepestDescents(const PointView& at, const DipoleCloud& from, float radius,
                                    int threads);
/// \param radii one a place
std::vector<float> steepestDescents(const PointView& at, const DipoleCloud& from,
                                    const std::vector<float>& radii, int threads);

/// How a sum of winding numbers, each times the value of its place, grows with the dipole of a
/// point: the transpose of windingNumbers(). sum v (x - p) / (4 pi s^(3/2)), where the first of the
/// four floats of `dipoles` is v. \return 4 floats a place, the last is 0
std::vector<float> windingPulls(const PointView& at, const DipoleCloud& from, float radius,
                                int threads);

}  // namespace segorient
