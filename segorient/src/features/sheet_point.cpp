// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "features/slope_gain.h"

namespace segorient::detail {
namespace {

// A hundredth of a spacing, squared: smaller neighbourhoods have nothing to gain, and of 33 points
// none is as far off the plane as two walls are apart.
constexpr float kFlat = 1e-4F;

// Over neighbourhoods from number `smallest` of kSheetScales on: from the largest down, a smaller
// one where it is clearly flatter, if it is not of one line of a scanner. The curvature is the
// variation over 18 neighbours, or 32 where noise hides smaller ones or all lie on one plane.
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
    if (!p.valid || p.lambda[1] < kOneScanLine * p.lambda[2]) continue;
    if (s == kCurvature) out.curvature = p.variation();
    const Plane& best = out.plane;
    const bool better = !best.valid || p.lambda[0] * best.lambda[1] <
                                           kClearlyFlatter * best.lambda[0] * p.lambda[1];
    if (better && !of.isContour(s, p)) out.plane = p;
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

bool Neighborhood::isContour(std::size_t scale, const Plane& plane) const {
  return lines_ && !tellsSlope({points_, points_, nb_}, i_, kSheetScales[scale],
                               plane.normal.data(), kGainOnConic);
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
  return fit;
}

namespace {

// Points wait until there are enough of them to look for their walls at once.
class WallSearch {
 public:
  WallSearch(const LocalFitJob& job, const float* spacing, bool thin)
      : job_(job), spacing_(spacing), most_apart_(thin ? kThinWallsApart : kWallsApart) {
    look_.xyz = job.xyz;
    look_.most_apart = most_apart_;
  }

  void add(std::size_t i, PointFit& fit) {
    if (!fit.plane.valid || fit.all_on_it) return;
    // Those with few neighbours are not worth registers.
    if (job_.neighborhoods->count(i) < static_cast<int>(kWallEntries) || !(spacing_[i] > 0.F)) {
      keepOwnWall(i, fit);
      return;
    }
    look_.own[count_] = job_.xyz + 4 * i;
    look_.rows[count_] = job_.neighborhoods->indices(i);
    look_.normal_x[count_] = fit.plane.normal.x();
    look_.normal_y[count_] = fit.plane.normal.y();
    look_.normal_z[count_] = fit.plane.normal.z();
    look_.per_spacing[count_] = 1.F / spacing_[i];
    waiting_[count_++] = {i, &fit};
    if (count_ == WallRows::kRows) finish();
  }

  void finish() {
    if (count_ == 0) return;
    // Lanes that are left look at the first point.
    std::fill(look_.own + count_, std::end(look_.own), look_.own[0]);
    std::fill(look_.rows + count_, std::end(look_.rows), look_.rows[0]);
    const std::uint32_t found = seesTwoWalls(look_);
    for (std::size_t l = 0; l < count_; ++l) {
      if ((found >> l & 1U) != 0) keepOwnWall(waiting_[l].first, *waiting_[l].second);
    }
    count_ = 0;
  }

 private:
  void keepOwnWall(std::size_t i, PointFit& fit) const {
    const Offsets offsets = gatherOffsets(job_.queries, *job_.neighborhoods, i, spacing_[i]);
    const OwnWall own = fitOwnWall(offsets, fit.plane, most_apart_);
    fit.plane = own.plane;
    fit.split = own.split;
  }

  const LocalFitJob& job_;
  const float* spacing_;
  float most_apart_;
  WallRows look_{};
  std::array<std::pair<std::size_t, PointFit*>, WallRows::kRows> waiting_{};
  std::size_t count_ = 0;
};

}  // namespace

void keepOwnWalls(const LocalFitJob& job, const float* spacing, bool thin,
                  std::vector<PointFit>& fits) {
  WallSearch search(job, spacing, thin);
  for (std::size_t r = 0; r < fits.size(); ++r) search.add(job.row(r), fits[r]);
  search.finish();
}

}  // namespace segorient::detail
