// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::detail {

/// The places that points have, in ascending order.
/// \param places_of_points 3 floats a point, NaN = unknown
/// \param of resized to the points: which of them each has, -1 = none
std::vector<std::array<float, 3>> numberPlaces(const std::vector<float>& places_of_points,
                                               std::vector<std::int32_t>& of);

/// Gives each scan that is said to have been seen from the place of another one, of several places,
/// a place of its own.
/// \param scan_of_points -1 = unknown; empty where none is known
/// \param least points: what has fewer stays with the other scan
/// \param places those of numberPlaces(); repeated at the end for further scans
/// \param of of numberPlaces(); changed
/// \return the scan of each place, -1 = unknown or several
std::vector<std::int32_t> splitByScan(const std::vector<std::int32_t>& scan_of_points,
                                      std::size_t least, std::vector<std::array<float, 3>>& places,
                                      std::vector<std::int32_t>& of);

}  // namespace segorient::detail
