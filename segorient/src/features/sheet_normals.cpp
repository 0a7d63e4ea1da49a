// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/median.h>
#include <segorient/common/threads.h>
#include <segorient/features/sheet_normals.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sheet_fit.h"

namespace segorient {
namespace {

using detail::fitPlane;
using detail::gatherOffsets;
using detail::Moments;
using detail::Offsets;
using detail::Plane;
using detail::WallSplit;

// Distance from the plane over the k nearest, in spacings; a plane takes three degrees of freedom.
float residualOver(const Offsets& o, int k) {
  Moments m;
  m.addOrigin();
  for (std::size_t j = 0; j < static_cast<std::size_t>(std::min(k, o.n)); ++j) {
    m.add(o.x[j], o.y[j], o.z[j]);
  }
  const Plane p = fitPlane(m);
  if (!p.valid || m.n <= 3.F) return std::numeric_limits<float>::quiet_NaN();
  return std::sqrt(p.lambda[0] * m.n / (m.n - 3.F));
}

// Noise hides what small neighbourhoods could tell: the first of 8, 12, 18 and 32 that it leaves.
// In a small neighbourhood a plane tilts by about noise / (2 radius), and these keep that below 15
// degrees.
int smallestScale(float noise) {
  if (noise >= 0.31F) return 3;
  if (noise >= 0.24F) return 2;
  return noise >= 0.13F ? 1 : 0;
}

struct PointFit {
  Plane plane;
  float curvature = 0.F;
  WallSplit split;
};

PointFit fitPoint(const Offsets& o, int smallest, float noise, const SheetNormalOptions& options) {
  // A fit this much worse than the noise spans an edge, a wall or strong curvature. Beyond a third
  // of a spacing, planes through single triples of points are no longer worth comparing.
  constexpr float kMostNoise = 0.33F;
  PointFit fit;
  const detail::AdaptivePlane adaptive = detail::fitAdaptive(o, smallest);
  fit.plane = adaptive.plane;
  fit.curvature = adaptive.curvature;
  if (!fit.plane.valid) return fit;
  if (options.dominant_plane && noise < kMostNoise &&
      std::sqrt(fit.plane.lambda[0]) > 0.03F + 2.F * noise) {
    const Plane dominant = detail::fitDominant(o, fit.plane, 0.1F + 2.F * noise);
    if (dominant.valid) fit.plane = dominant;
  }
  for (int round = 0; options.split_walls && round < 2; ++round) {
    fit.split = detail::splitWalls(o, fit.plane.normal);
    if (!fit.split.found) break;
    const Plane own = detail::fitWithin(o, fit.plane.normal, fit.split);
    if (!own.valid) break;
    fit.plane = own;
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

void judgeReliability(const std::vector<float>& lopsided, SheetNormals& out) {
  std::vector<float> residuals;
  residuals.reserve(out.spacing.size());
  for (std::size_t i = 0; i < out.spacing.size(); ++i) {
    if (std::isfinite(out.normals[4 * i + 3])) residuals.push_back(out.normals[4 * i + 3]);
  }
  out.residual = median(std::move(residuals));
  for (std::size_t i = 0; i < out.spacing.size(); ++i) {
    const float r = out.normals[4 * i + 3];
    out.reliable[i] = r < 2.5F * out.residual + 0.1F && lopsided[i] < 0.6F ? 1 : 0;
  }
}

}  // namespace

NoiseLevel measureNoise(const PointView& points, const Neighborhoods& nb, int threads) {
  constexpr std::size_t kSamples = 4096;
  const std::size_t step = std::max<std::size_t>(1, points.size / kSamples);
  const std::size_t n = (points.size + step - 1) / step;
  std::vector<float> fine(n);
  std::vector<float> coarse(n);
  const int t = resolveThreads(threads);
#pragma omp parallel for num_threads(t) schedule(dynamic, 64)
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t i = s * step;
    const Offsets o = gatherOffsets(points, nb, i, detail::meanDistance(points, nb, i, 6));
    fine[s] = residualOver(o, 8);
    coarse[s] = residualOver(o, kSheetNeighbors);
  }
  const auto drop = [](std::vector<float>& v) {
    v.erase(std::remove_if(v.begin(), v.end(), [](float r) { return !std::isfinite(r); }), v.end());
    return median(std::move(v));
  };
  return {drop(fine), drop(coarse)};
}

SheetNormals estimateSheetNormals(const PointView& points, const Neighborhoods& nb,
                                  const SheetNormalOptions& options) {
  SheetNormals out;
  const std::size_t n = points.size;
  out.normals.resize(4 * n);
  out.spacing.resize(n);
  out.curvature.resize(n);
  out.below.resize(n);
  out.above.resize(n);
  out.reliable.resize(n);
  out.noise = measureNoise(points, nb, options.threads).fine;
  const int smallest = smallestScale(out.noise);
  constexpr int kSizes[] = {8, 12, 18, kSheetNeighbors};
  out.scale = kSizes[smallest];

  std::vector<float> lopsided(n, std::numeric_limits<float>::infinity());
  const int threads = resolveThreads(options.threads);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1024)
  for (std::size_t i = 0; i < n; ++i) {
    out.spacing[i] = detail::meanDistance(points, nb, i, 6);
    const Offsets o = gatherOffsets(points, nb, i, out.spacing[i]);
    store(fitPoint(o, smallest, out.noise, options), i, out, lopsided);
  }
  judgeReliability(lopsided, out);
  return out;
}

}  // namespace segorient
