// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "features/sheet_fit.h"
#include "features/sheet_normals.h"
#include "features/sheet_walls.h"

namespace segorient {
namespace {

using detail::fitPlane;
using detail::gatherOffsets;
using detail::kFirstRing;
using detail::meanDistance;
using detail::Moments;
using detail::momentsOf;
using detail::Offsets;
using detail::Plane;

// Distance from the plane through some offsets, in spacings; it takes three degrees of freedom.
float residualOf(const Moments& m) {
  const Plane p = fitPlane(m);
  if (!p.valid || m.n <= 3.F) return std::numeric_limits<float>::quiet_NaN();
  return std::sqrt(p.lambda[0] * m.n / (m.n - 3.F));
}

// Distance from the plane over the k nearest of the point's own wall; NaN where two cannot be told
// apart.
float wallResidual(const Offsets& o, int k) {
  const Plane start = fitPlane(momentsOf(o, o.n));
  if (!start.valid) return std::numeric_limits<float>::quiet_NaN();
  const auto [plane, split] = detail::fitOwnWall(o, start, detail::kThinWallsApart);
  if (!split.found) return std::numeric_limits<float>::quiet_NaN();
  Moments own;
  own.addOrigin();
  for (std::size_t j = 0; j < static_cast<std::size_t>(o.n) && own.n <= static_cast<float>(k);
       ++j) {
    const float t = o.along(j, plane.normal);
    if (t > split.below && t < split.above) own.add(o.x[j], o.y[j], o.z[j]);
  }
  return residualOf(own);
}

}  // namespace

NoiseLevel measureNoise(const PointView& points, const Neighborhoods& nb, int threads) {
  // Medians of so many are known to some percent; the finest scale has a ring and a little more.
  constexpr std::size_t kSamples = 4096;
  constexpr int kFine = 8;
  // Of noise alone, one sample in 200 looks like two walls; of plates of two spacings with noise of
  // a quarter to .4 of one, a tenth to a half of the samples.
  constexpr float kThinShare = 0.1F;
  const detail::EveryNth samples(points.size, kSamples);
  const std::size_t n = samples.size();
  // The median of what can be told of the samples.
  const auto medianOver = [&](const auto& residual, std::size_t& told) {
    std::vector<float> found(n);
    parallelFor(n, threads, 2000.0, [&](std::size_t s) {
      const std::size_t i = samples[s];
      found[s] = residual(gatherOffsets(points, nb, i, meanDistance(points, nb, i, kFirstRing)));
    });
    found.erase(
        std::remove_if(found.begin(), found.end(), [](float r) { return !std::isfinite(r); }),
        found.end());
    told = found.size();
    return median(std::move(found));
  };
  NoiseLevel noise;
  std::size_t told = 0;
  noise.fine = medianOver([](const Offsets& o) { return residualOf(momentsOf(o, kFine)); }, told);
  noise.coarse =
      medianOver([](const Offsets& o) { return residualOf(momentsOf(o, kSheetNeighbors)); }, told);
  if (noise.fine < detail::kFewTellNothing) return noise;
  const float walls = medianOver([](const Offsets& o) { return wallResidual(o, kFine); }, told);
  noise.thin = static_cast<float>(told) >= kThinShare * static_cast<float>(n);
  if (noise.thin) noise.fine = walls;
  return noise;
}

}  // namespace segorient
