// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient::detail {

/// An even subset of a cloud, and the cell of the cloud that each of its points stands for.
struct BlueNoise {
  std::vector<std::uint32_t> kept;     ///< rows, ascending: no two nearer than the radius
  std::vector<std::uint32_t> cell_of;  ///< one a point, into `kept`: the nearest kept one
};

/// Thins a cloud so that no two points are nearer than a radius and none that was left out is
/// farther than that from a kept one. Points are taken in their order if nothing kept is near: the
/// same subset for any number of threads. Linear.
///
/// \param points finite, with an extent of about 1 (PreparedCloud)
/// \param radius nothing is kept if it is not above 1e-12, as floats cannot tell then
BlueNoise thinOut(const PointView& points, float radius, int threads);

/// Of each cell, where its points are in the mean: 4 floats, the last is 0.
std::vector<float> meanPlaces(const PointView& points, const BlueNoise& cells);

}  // namespace segorient::detail
