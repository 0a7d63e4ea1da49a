// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/packed_values.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace segorient::program {
namespace {

// The leading bits of a float from 2^-24 up to 2: five of the exponent, the others of the mantissa.
constexpr unsigned kMantissa = kCurvatureBits - 5;
constexpr std::uint32_t kLeast = (127U - 30U) << kMantissa;

std::uint32_t toGrid(float x, std::uint32_t most) {
  const float at = (x * 0.5F + 0.5F) * static_cast<float>(most);
  return std::min(most, static_cast<std::uint32_t>(std::max(0.F, std::round(at))));
}

float fromGrid(std::uint32_t at, std::uint32_t most) {
  return 2.F * static_cast<float>(at) / static_cast<float>(most) - 1.F;
}

}  // namespace

std::uint32_t packNormal(const float* n, unsigned bits) {
  const std::uint32_t most = (1U << bits / 2) - 2U;  // even, so that 0 is on the grid
  const float sum = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
  float x = sum > 0.F ? n[0] / sum : 0.F;
  float y = sum > 0.F ? n[1] / sum : 0.F;
  if (n[2] < 0.F) {
    const float folded = (1.F - std::fabs(y)) * (x < 0.F ? -1.F : 1.F);
    y = (1.F - std::fabs(x)) * (y < 0.F ? -1.F : 1.F);
    x = folded;
  }
  return toGrid(x, most) | toGrid(y, most) << bits / 2;
}

void unpackNormal(std::uint32_t packed, unsigned bits, float* n) {
  const std::uint32_t most = (1U << bits / 2) - 2U;
  const std::uint32_t mask = (1U << bits / 2) - 1U;
  float x = fromGrid(packed & mask, most);
  float y = fromGrid(packed >> bits / 2 & mask, most);
  const float z = 1.F - std::fabs(x) - std::fabs(y);
  if (z < 0.F) {
    const float folded = (1.F - std::fabs(y)) * (x < 0.F ? -1.F : 1.F);
    y = (1.F - std::fabs(x)) * (y < 0.F ? -1.F : 1.F);
    x = folded;
  }
  const float length = std::sqrt(x * x + y * y + z * z);
  n[0] = x / length;
  n[1] = y / length;
  n[2] = z / length;
}

std::uint32_t packCurvature(float c) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &c, sizeof(bits));
  const std::uint32_t half = 1U << (22U - kMantissa);
  const std::uint32_t leading = (bits + half) >> (23U - kMantissa);
  if (!(c > 0.F) || leading <= kLeast) return 0;
  return std::min(leading - kLeast, (1U << kCurvatureBits) - 1U);
}

float unpackCurvature(std::uint32_t packed) {
  if (packed == 0) return 0.F;
  const std::uint32_t bits = (packed + kLeast) << (23U - kMantissa);
  float c = 0.F;
  std::memcpy(&c, &bits, sizeof(c));
  return c;
}

}  // namespace segorient::program
