// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>

namespace segorient::program {

/// The label of a point in no segment, as it is written.
constexpr std::uint32_t kNoSegment = 0xffffffffU;

/// The side that normals point to.
constexpr std::uint32_t kFrontColor = 0xe6e2d8U;

/// One part of a colour and three of the front's: segments differ, and none looks like a back.
std::uint32_t tinted(std::uint32_t color);

/// Packed rgb of a segment: neighbouring labels get colours far apart; grey without a segment.
std::uint32_t segmentColor(std::uint32_t label);

/// Packed rgb of a number between 0 and 1, from dark blue over green to yellow: lighter is more,
/// for colour-blind eyes as well. What is not finite is grey.
std::uint32_t rampColor(double value);

}  // namespace segorient::program
