// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>

// Numbers in as few bits as what they are for needs.
namespace segorient::program {

/// Bits of a packed normal: to three hundredths of a degree. A third of that many would spoil what
/// surfaces without noise tell.
constexpr unsigned kNormalBits = 26;
constexpr std::uint64_t kNoNormal = (std::uint64_t{1} << kNormalBits) - 1;  ///< of no normal
/// Bits of a packed curvature, of which PCL's definition leaves 0 to 1/3: to a 256th of it.
constexpr unsigned kCurvatureBits = 12;

/// A unit vector as a place in a square onto which the sphere is folded (an octahedron's faces).
/// \param bits even, 2 to 32: of both coordinates
std::uint32_t packNormal(const float* n, unsigned bits);
void unpackNormal(std::uint32_t packed, unsigned bits, float* n);

/// A number from 0 to below 2 by the leading bits of its logarithm; 0 stays 0.
std::uint32_t packCurvature(float c);
float unpackCurvature(std::uint32_t packed);

}  // namespace segorient::program
