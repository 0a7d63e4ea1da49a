// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/colors.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace segorient::program {

std::uint32_t tinted(std::uint32_t color) {
  std::uint32_t out = 0;
  for (const unsigned shift : {0U, 8U, 16U}) {
    const std::uint32_t own = color >> shift & 255U;
    const std::uint32_t front = kFrontColor >> shift & 255U;
    out |= (own + 3 * front) / 4 << shift;
  }
  return out;
}

std::uint32_t segmentColor(std::uint32_t label) {
  if (label == kNoSegment) return 0x909090U;
  // Steps of the golden ratio spread any number of hues; brightness and saturation alternate so
  // that hues that come near again still differ.
  const double turn = 0.61803398875 * static_cast<double>(label) + 0.08;
  const double hue = 6.0 * (turn - std::floor(turn));
  const double saturation = std::array<double, 3>{0.72, 0.50, 0.88}[label % 3];
  const double value = std::array<double, 4>{0.95, 0.80, 0.90, 0.65}[label / 3 % 4];
  const auto channel = [&](double shift) {
    const double k = shift + hue < 6.0 ? shift + hue : shift + hue - 6.0;
    const double t = std::max(0.0, std::min({k, 4.0 - k, 1.0}));
    return static_cast<std::uint32_t>(255.0 * (value - value * saturation * t) + 0.5);
  };
  return channel(5.0) << 16 | channel(3.0) << 8 | channel(1.0);
}

std::uint32_t rampColor(double value) {
  if (!std::isfinite(value)) return 0x909090U;
  static constexpr std::array<std::array<double, 3>, 4> kStops{
      {{48, 37, 107}, {43, 122, 155}, {88, 179, 104}, {242, 227, 90}}};
  const double t = std::fmax(0.0, std::fmin(value, 1.0)) * (kStops.size() - 1);
  const auto stop = std::min(static_cast<std::size_t>(t), kStops.size() - 2);
  std::uint32_t out = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double from = kStops[stop][c];
    const double mixed = from + (kStops[stop + 1][c] - from) * (t - static_cast<double>(stop));
    out = out << 8 | static_cast<std::uint32_t>(mixed + 0.5);
  }
  return out;
}

}  // namespace segorient::program
