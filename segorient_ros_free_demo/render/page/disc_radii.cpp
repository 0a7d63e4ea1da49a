// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/disc_radii.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/threads.h"

namespace segorient::program {
namespace {

constexpr float kLargest = 3.F;  // times the middle

}  // namespace

std::vector<float> discRadii(const Neighborhoods& neighborhoods, float& middle, int threads) {
  std::vector<float> radii(neighborhoods.size(), -1.F);  // not known
  const auto size = static_cast<std::ptrdiff_t>(radii.size());
#pragma omp parallel for schedule(static, 4096) num_threads(resolveThreads(threads))
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const int count = neighborhoods.count(i);
    if (count < 2) continue;
    const float radius = std::sqrt(neighborhoods.sqrDistances(i)[std::min(kCover, count - 1)]);
    if (std::isfinite(radius)) radii[i] = radius;  // its square overflows; a dot does
  }
  std::vector<float> known;
  known.reserve(radii.size());
  std::copy_if(radii.begin(), radii.end(), std::back_inserter(known),
               [](float r) { return r >= 0.F; });
  middle = 0.F;
  if (known.empty()) return std::vector<float>(radii.size(), 0.F);
  const auto at = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), at, known.end());
  middle = *at;
  for (float& r : radii) r = std::clamp(r, 0.F, kLargest * middle);
  return radii;
}

}  // namespace segorient::program
