// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/disc_radii.h"

#include <algorithm>
#include <cmath>

namespace segorient::program {
namespace {

constexpr float kLargest = 3.F;  // times the middle

}  // namespace

std::vector<float> discRadii(const Neighborhoods& neighborhoods, float& middle) {
  std::vector<float> radii(neighborhoods.size(), 0.F);
  std::vector<float> known;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const int count = neighborhoods.count(i);
    if (count < 2) continue;
    const float radius = std::sqrt(neighborhoods.sqrDistances(i)[std::min(kCover, count - 1)]);
    if (!std::isfinite(radius)) continue;  // its square overflows; a dot does
    radii[i] = radius;
    known.push_back(radius);
  }
  middle = 0.F;
  if (known.empty()) return radii;
  const auto at = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), at, known.end());
  middle = *at;
  for (float& r : radii) r = std::min(r, kLargest * middle);
  return radii;
}

}  // namespace segorient::program
