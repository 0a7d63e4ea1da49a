// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstdint>
#include <vector>

namespace segorient::program {

/// Rows of finite points, at most `most` of them, in an order of which every beginning is spread
/// evenly (blue noise): dart throwing with radii that halve from level to level. Neither the order
/// of the input's rows nor chance plays a part: darts come in the order of a hash of their
/// coordinates.
std::vector<std::uint32_t> blueNoiseOrder(const PointView& points, std::size_t most);

/// Sorts an order in space, level by level: each level is a quarter of the points before it, so
/// that up to the end of any level they are spread as evenly as before.
/// \return ends of levels, the last the number of points
std::vector<std::size_t> sortLevels(const PointView& points, std::vector<std::uint32_t>& order,
                                    int threads);

}  // namespace segorient::program
