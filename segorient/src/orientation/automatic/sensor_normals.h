// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>

#include <cstdint>
#include <vector>

#include "features/more_neighbors.h"

namespace segorient::detail {

/// Final normals where the sensor is known: what it tells of a normal beside its side.
///
/// A surface is sampled in proportion to the cosine at which it is seen, and not at all from
/// behind. So of the directions that a normal may have, given that it is known to s radians, those
/// that were seen face on are more likely: the most likely one maximizes log(n . v) - |n - m|^2 /
/// (2 s^2). Where the normal is sure it stays, to the last degree of a grazing view; beside edges
/// and in noise, where planes of several sizes and the normals around contradict each other, it
/// leans to the sensor, so that no error of its line takes it to the other side.
///
/// \param more the points, and neighbours beyond those of the table where planes contradict each
///        other
/// \param neighborhoods of the points
/// \param toward 3 a point: unit vector to its sensor; 0 = unknown, and the normal stays
/// \param sure one a point, or none: normals that stay as far as their side allows, whatever the
///        planes around say, which near an edge are of both faces
/// \param only_many_show_noise see SheetTraits
/// \param normals 4 floats a point, oriented; changed but for the fourth
void leanToSensors(MoreNeighbors& more, const Neighborhoods& neighborhoods,
                   const std::vector<float>& toward, const std::vector<std::uint8_t>& sure,
                   bool only_many_show_noise, int threads, std::vector<float>& normals);

}  // namespace segorient::detail
