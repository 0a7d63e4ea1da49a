// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "common/median.h"
#include "common/threads.h"
#include "features/grown_planes.h"
#include "features/local_fit_job.h"
#include "features/more_neighbors.h"
#include "features/scan_scale.h"
#include "features/sheet_fit.h"
#include "features/sheet_walls.h"

namespace segorient {
namespace {

using detail::fitPlane;
using detail::FourFloats;
using detail::gatherOffsets;
using detail::GrownPlanes;
using detail::jobOf;
using detail::LocalFitJob;
using detail::Moments;
using detail::Offsets;
using detail::Plane;
using detail::WallSplit;

// Distance from the plane through some offsets, in spacings; it takes three degrees of freedom.
float residualOf(const Moments& m) {
  const Plane p = fitPlane(m);
  if (!p.valid || m.n <= 3.F) return std::numeric_limits<float>::quiet_NaN();
  return std::sqrt(p.lambda[0] * m.n / (m.n - 3.F));
}

// The same over the k nearest.
float residualOver(const Offsets& o, int k) {
  Moments m;
  m.addOrigin();
  for (std::size_t j = 0; j < static_cast<std::size_t>(std::min(k, o.n)); ++j) {
    m.add(o.x[j], o.y[j], o.z[j]);
  }
  return residualOf(m);
}

/// Walls farther apart than that are told apart by their offset alone, and what else looks like two
/// classes at such a distance (clutter, a narrow bore) need not be walls.
constexpr float kWallsApart = 1.25F;
/// In thin clouds, where noise takes a point as far from its own wall: of walls farther apart, 32
/// neighbours hardly reach the other one.
constexpr float kThinWallsApart = 2.F;

struct OwnWall {
  Plane plane;
  WallSplit split;
};

// From a plane over all, the one over the point's own wall.
OwnWall fitOwnWall(const Offsets& o, const Plane& start, float most_apart) {
  OwnWall own{start, {}};
  for (int round = 0; round < 2; ++round) {
    own.split = detail::splitWalls(o, own.plane.normal, most_apart);
    if (!own.split.found) break;
    Plane refined = detail::fitWithin(o, own.plane.normal, own.split);
    if (!refined.valid) break;
    // What is above stays above.
    if (refined.normal.dot(own.plane.normal) < 0.F) refined.normal = -refined.normal;
    own.plane = refined;
  }
  return own;
}

// Distance from the plane over the k nearest of the point's own wall; NaN where two cannot be told
// apart.
float wallResidual(const Offsets& o, int k) {
  Moments all;
  all.addOrigin();
  for (std::size_t j = 0; j < static_cast<std::size_t>(o.n); ++j) all.add(o.x[j], o.y[j], o.z[j]);
  const Plane start = fitPlane(all);
  if (!start.valid) return std::numeric_limits<float>::quiet_NaN();
  const auto [plane, split] = fitOwnWall(o, start, kThinWallsApart);
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

// From here on, noise hides what the smallest neighbourhoods could tell. A plane leaves .13 of
// eight neighbours and the point with noise of s = .17, which tilts it by sqrt(2) s / (3 * .75),
// .75 being their extent along an axis: by 6 degrees, and by 15 in 2.5 standard deviations.
constexpr float kFewTellNothing = 0.13F;

// Noise hides what small neighbourhoods could tell: the first of 8, 12, 18 and 32 that it leaves.
// In a small neighbourhood a plane tilts by about noise / (2 radius), and these keep that below 15
// degrees.
std::size_t smallestScale(float noise) {
  if (noise >= 0.31F) return 3;
  if (noise >= 0.24F) return 2;
  return noise >= kFewTellNothing ? 1 : 0;
}

struct PointFit {
  Plane plane;
  float curvature = 0.F;
  WallSplit split;
  bool all_on_it = false;  ///< none of the neighbours is off the plane
};

// A hundredth of a spacing, squared: smaller neighbourhoods have nothing to gain, and of 33 points
// none is as far off the plane as two walls are apart.
constexpr float kFlat = 1e-4F;

using SheetPlanes = std::array<GrownPlanes, kSheetScales.size()>;

/// One point and its neighbours; lengths in spacings.
class Neighborhood {
 public:
  // \param planes of its sizes, the point's at [r]
  Neighborhood(const PointView& points, const Neighborhoods& nb, std::size_t i, float spacing,
               const SheetPlanes& planes, std::size_t r)
      : points_(points), nb_(nb), i_(i), spacing_(spacing), planes_(planes), r_(r) {}

  const Offsets& offsets() {
    if (!offsets_) offsets_ = gatherOffsets(points_, nb_, i_, spacing_);
    return *offsets_;
  }

  Plane planeOf(std::size_t scale) {
    if (!planes_[scale].hasNormal(r_)) return planeInDouble(kSheetScales[scale]);
    return spacing_ > 0.F ? planes_[scale].at(r_, spacing_) : Plane{};
  }

 private:
  Plane planeInDouble(int k) {
    const Offsets& o = offsets();
    Moments m;
    m.addOrigin();
    for (std::size_t j = 0; j < static_cast<std::size_t>(std::min(k, o.n)); ++j)
      m.add(o.x[j], o.y[j], o.z[j]);
    return fitPlane(m);
  }

  const PointView& points_;
  const Neighborhoods& nb_;
  std::size_t i_;
  float spacing_;
  const SheetPlanes& planes_;
  std::size_t r_;
  std::optional<Offsets> offsets_;
};

// Over neighbourhoods from number `smallest` of kSheetScales on: from the largest down, a smaller
// one where it is clearly flatter. The curvature is the variation over 18 neighbours, or 32 where
// noise hides smaller ones.
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

PointFit fitPoint(Neighborhood& of, std::size_t smallest, const NoiseLevel& noise,
                  const SheetNormalOptions& options) {
  // A fit this much worse than the noise spans an edge, a wall or strong curvature. Beyond a third
  // of a spacing, planes through single triples of points are no longer worth comparing.
  constexpr float kMostNoise = 0.33F;
  PointFit fit = fitAdaptive(of, smallest);
  if (!fit.plane.valid || fit.all_on_it) return fit;
  if (options.dominant_plane && noise.fine < kMostNoise &&
      std::sqrt(fit.plane.lambda[0]) > 0.03F + 2.F * noise.fine) {
    const Plane dominant = detail::fitDominant(of.offsets(), fit.plane, 0.1F + 2.F * noise.fine);
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

// How far the neighbours' mean lies to one side, in units of their extent: large at borders and
// holes.
float asymmetry(const Plane& plane) {
  const Eigen::Vector3f tangential = plane.mean - plane.mean.dot(plane.normal) * plane.normal;
  const float extent = std::sqrt(plane.lambda[1] + plane.lambda[2]);
  return extent > 0.F ? tangential.norm() / extent : 0.F;
}

void store(const PointFit& fit, std::size_t i, SheetNormals& out, std::vector<float>& lopsided) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  float* w = out.normals.data() + 4 * i;
  const float h = out.spacing[i];
  out.below[i] = fit.split.below * h;
  out.above[i] = fit.split.above * h;
  if (!fit.plane.valid || !(h > 0.F)) {
    std::fill(w, w + 4, kNaN);
    out.curvature[i] = kNaN;
    return;
  }
  std::copy(fit.plane.normal.data(), fit.plane.normal.data() + 3, w);
  w[3] = std::sqrt(fit.plane.lambda[0]);
  out.curvature[i] = fit.curvature;
  lopsided[i] = asymmetry(fit.plane);
}

float medianResidual(const SheetNormals& out) {
  std::vector<float> residuals;
  residuals.reserve(out.spacing.size());
  for (std::size_t i = 0; i < out.spacing.size(); ++i) {
    if (std::isfinite(out.normals[4 * i + 3])) residuals.push_back(out.normals[4 * i + 3]);
  }
  return median(std::move(residuals));
}

void judgeReliability(const std::vector<float>& lopsided, SheetNormals& out) {
  for (std::size_t i = 0; i < out.spacing.size(); ++i) {
    const float r = out.normals[4 * i + 3];
    out.reliable[i] = r < 2.5F * out.residual + 0.1F && lopsided[i] < 0.6F ? 1 : 0;
  }
}

}  // namespace

NoiseLevel measureNoise(const PointView& points, const Neighborhoods& nb, int threads) {
  // Medians of so many are known to some percent; the finest scale has a ring and a little more.
  constexpr std::size_t kSamples = 4096;
  constexpr int kFine = 8;
  // Of noise alone, one sample in 200 looks like two walls; of plates of two spacings with noise of
  // a quarter to .4 of one, a tenth to a half of the samples.
  constexpr float kThinShare = 0.1F;
  const std::size_t step = std::max<std::size_t>(1, points.size / kSamples);
  const std::size_t n = (points.size + step - 1) / step;
  const int t = resolveThreads(threads, n, 2000.0);
  // The median of what can be told of the samples.
  const auto medianOver = [&](const auto& residual, std::size_t& told) {
    std::vector<float> found(n);
#pragma omp parallel for num_threads(t) schedule(dynamic, 64)
    for (std::size_t s = 0; s < n; ++s) {
      const std::size_t i = s * step;
      found[s] = residual(gatherOffsets(points, nb, i, detail::meanDistance(points, nb, i, 6)));
    }
    found.erase(
        std::remove_if(found.begin(), found.end(), [](float r) { return !std::isfinite(r); }),
        found.end());
    told = found.size();
    return median(std::move(found));
  };
  NoiseLevel noise;
  std::size_t told = 0;
  noise.fine = medianOver([](const Offsets& o) { return residualOver(o, kFine); }, told);
  noise.coarse =
      medianOver([](const Offsets& o) { return residualOver(o, kSheetNeighbors); }, told);
  if (noise.fine < kFewTellNothing) return noise;
  const float walls = medianOver([](const Offsets& o) { return wallResidual(o, kFine); }, told);
  noise.thin = static_cast<float>(told) >= kThinShare * static_cast<float>(n);
  if (noise.thin) noise.fine = walls;
  return noise;
}

SheetNormals estimateSheetNormals(const PointView& points, const Neighborhoods& nb,
                                  const SheetNormalOptions& options, detail::MoreNeighbors* more) {
  SheetNormals out;
  const std::size_t n = points.size;
  out.normals.resize(4 * n);
  out.spacing.resize(n);
  out.curvature.resize(n);
  out.below.resize(n);
  out.above.resize(n);
  out.reliable.resize(n);
  const NoiseLevel noise =
      options.known ? options.known->noise : measureNoise(points, nb, options.threads);
  out.traits.noise = noise;
  out.noise = noise.fine;
  const std::size_t smallest = smallestScale(noise.fine);
  out.scale = kSheetScales[smallest];

  std::vector<float> lopsided(n, std::numeric_limits<float>::infinity());
  const int threads = resolveThreads(options.threads, n, 2000.0);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1024)
  for (std::size_t i = 0; i < n; ++i) out.spacing[i] = detail::meanDistance(points, nb, i, 6);
  out.traits.scan_scales =
      options.known
          ? options.known->scan_scales
          : !noise.thin &&
                (options.scan_scales ||
                 (options.scan_lines && detail::showsScanLines(points, nb, options.threads))) &&
                detail::needsScanScales(points, nb, out.scale, options.threads);
  std::vector<std::uint8_t> done;
  if (out.traits.scan_scales) {
    done.resize(n);
    detail::MoreNeighbors own(points, options.threads);
    detail::fitScanPlanes(more != nullptr ? *more : own, out.scale,
                          [&](std::size_t i, const GrownPlanes& planes, std::size_t r) {
                            const Plane p = planes.at(r, out.spacing[i]);
                            store({p, p.variation(), {}, false}, i, out, lopsided);
                            done[i] = 1;
                          });
  }
  const FourFloats xyz(points);
  LocalFitJob all = jobOf(points, xyz, nb, kSheetNeighbors);
  all.same_points = true;
#pragma omp parallel num_threads(threads)
  {
    LocalFitJob job = all;
    std::vector<pcl::index_t> rows;
    const auto planes = std::make_unique<SheetPlanes>();
#pragma omp for schedule(dynamic, 4)
    for (std::size_t begin = 0; begin < n; begin += GrownPlanes::kRows) {
      rows.clear();
      for (std::size_t i = begin; i < std::min(n, begin + GrownPlanes::kRows); ++i) {
        if (done.empty() || done[i] == 0) rows.push_back(static_cast<pcl::index_t>(i));
      }
      job.rows = rows.data();
      fitGrownPlanes(job, kSheetScales.data(), kSheetScales.size(), 0, rows.size(), planes->data());
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const auto i = static_cast<std::size_t>(rows[r]);
        Neighborhood of(points, nb, i, out.spacing[i], *planes, r);
        store(fitPoint(of, smallest, noise, options), i, out, lopsided);
      }
    }
  }
  out.residual = options.known ? options.known->residual : medianResidual(out);
  out.traits.residual = out.residual;
  judgeReliability(lopsided, out);
  return out;
}

}  // namespace segorient
