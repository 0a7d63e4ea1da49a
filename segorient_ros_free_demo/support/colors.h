// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>

namespace segorient::program {

constexpr std::uint32_t kNoSegment = 0xffffffffU;  ///< label of a point that is in no segment

/// Packed 0xRRGGBB of a segment: depends on the label only, neighbours in number are far apart in
/// hue. Points of no segment are grey.
std::uint32_t segmentColor(std::uint32_t label);

}  // namespace segorient::program
