// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_point.h"

#include <algorithm>
#include <cmath>

namespace segorient::detail {
namespace {

// A hundredth of a spacing, squared: smaller neighbourhoods have nothing to gain, and of 33 points
// none is as far off the plane as two walls are apart.
constexpr float kFlat = 1e-4F;

// Over neighbourhoods from number `smallest` of kSheetScales on: from the largest down, a smaller
// one where it is clearly flatter. The curvature is the variation over 18 neighbours, or 32 where
// noise hides smaller ones or all lie on one plane.
PointFit fitAdaptive(Neighborhood& of, std::size_t smallest) {
  // Of the share of variance that the larger neighbourhood leaves. Noise makes that of 18 of 32
  // neighbours so small for one point in 400, of 12 of 18 for 1 in 50 (beta distribution).
  constexpr float kClearlyFlatter = 0.6F;
  constexpr std::size_t kLargest = kSheetScales.size() - 1;
  // The scale of 18 neighbours: the two rings around a point of an even grid.
  constexpr std::size_t kCurvature = 2;
  PointFit out;
  out.plane = of.planeOf(kLargest);
  out.curvature = out.plane.variation();
  out.all_on_it = out.plane.valid && out.plane.lambda[0] < kFlat;
  if (out.all_on_it) return out;
  for (std::size_t s = kLargest; s-- > smallest;) {
    const Plane p = of.planeOf(s);
    if (!p.valid) continue;
    if (s == kCurvature) out.curvature = p.variation();
    const Plane& best = out.plane;
    if (!best.valid ||
        p.lambda[0] * best.lambda[1] < kClearlyFlatter * best.lambda[0] * p.lambda[1]) {
      out.plane = p;
    }
  }
  return out;
}

}  // namespace

const Offsets& Neighborhood::offsets() {
  if (!offsets_) offsets_ = gatherOffsets(points_, nb_, i_, spacing_);
  return *offsets_;
}

Plane Neighborhood::planeOf(std::size_t scale) {
  if (!planes_[scale].hasNormal(r_)) return fitPlane(momentsOf(offsets(), kSheetScales[scale]));
  return spacing_ > 0.F ? planes_[scale].at(r_, spacing_) : Plane{};
}

PointFit fitPoint(Neighborhood& of, std::size_t smallest, const NoiseLevel& noise,
                  const SheetNormalOptions& options) {
  // A fit this much worse than the noise spans an edge, a wall or strong curvature. Beyond a third
  // of a spacing, planes through single triples of points are no longer worth comparing.
  constexpr float kMostNoise = 0.33F;
  PointFit fit = fitAdaptive(of, smallest);
  if (!fit.plane.valid || fit.all_on_it) return fit;
  if (options.dominant_plane && noise.fine < kMostNoise &&
      std::sqrt(fit.plane.lambda[0]) > 0.03F + 2.F * noise.fine) {
    const Plane dominant = fitDominant(of.offsets(), fit.plane, 0.1F + 2.F * noise.fine);
    if (dominant.valid) fit.plane = dominant;
  }
  if (options.split_walls) {
    const OwnWall own =
        fitOwnWall(of.offsets(), fit.plane, noise.thin ? kThinWallsApart : kWallsApart);
    fit.plane = own.plane;
    fit.split = own.split;
  }
  return fit;
}

}  // namespace segorient::detail
