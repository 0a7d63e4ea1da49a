// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>

#include <vector>

namespace segorient::program {

/// Neighbours within a disc. With eight, three in ten thousand spots of a randomly sampled surface
/// stay open.
constexpr int kCover = 8;

/// Radius of each row's disc: the distance of its eighth neighbour, but that of stray points not
/// much above the middle one. 0 where there is no neighbour.
/// \param middle gets the middle radius, 0 without any
/// \param threads 0 = all cores
std::vector<float> discRadii(const Neighborhoods& neighborhoods, float& middle, int threads);

}  // namespace segorient::program
