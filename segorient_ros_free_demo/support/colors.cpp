// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/colors.h"

#include <array>
#include <cmath>

namespace segorient::program {

std::uint32_t segmentColor(std::uint32_t label) {
  if (label == kNoSegment) return 0x909090U;
  // Steps of the golden ratio spread any number of hues; brightness and saturation alternate so
  // that hues that come near again still differ.
  const double turn = 0.61803398875 * static_cast<double>(label) + 0.08;
  const double hue = 6.0 * (turn - std::floor(turn));
  const double saturation = std::array<double, 3>{0.72, 0.50, 0.88}[label % 3];
  const double value = std::array<double, 4>{0.95, 0.80, 0.90, 0.65}[label / 3 % 4];
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue, 6.0);
    const double t = std::fmax(0.0, std::fmin(std::fmin(k, 4.0 - k), 1.0));
    return static_cast<std::uint32_t>(255.0 * (value - value * saturation * t) + 0.5);
  };
  return channel(5.0) << 16 | channel(3.0) << 8 | channel(1.0);
}

}  // namespace segorient::program
