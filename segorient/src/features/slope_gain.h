// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>

#include "features/cloud_noise.h"

namespace segorient::detail {

/// Of random points the nearest ten are above that at one in ten, the nearest 16 at one in a
/// hundred; those of two lines have tens and thousands.
constexpr double kMostGain = 4.0;
/// Of random points the nearest eight are above that at one in a thousand.
constexpr double kGainOnConic = 20.0;

/// Whether the k nearest of a row tell the slope of their quadratic surface. Those on a conic do
/// not, whatever is left of them: two lines of a scanner are one, and any multiple of the product
/// of their equations may be added to the surface. So the slope's variance, for equal noise of
/// all, must not be far above that of the plane of as many points spread evenly.
/// \param most of the standard deviations, see kMostGain
/// \param normal of the surface, to tell where the neighbours lie along it
bool tellsSlope(const Surroundings& of, std::size_t row, int k, const float* normal,
                double most = kMostGain);

}  // namespace segorient::detail
