// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_normals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "common/median.h"
#include "common/parallel_for.h"
#include "features/grown_planes.h"
#include "features/local_fit_job.h"
#include "features/more_neighbors.h"
#include "features/scan_scale.h"
#include "features/sheet_fit.h"
#include "features/sheet_point.h"
#include "features/spread_planes.h"

namespace segorient {
namespace {

using detail::FourFloats;
using detail::GrownPlanes;
using detail::jobOf;
using detail::LocalFitJob;
using detail::Neighborhood;
using detail::Plane;
using detail::PointFit;
using detail::SheetPlanes;

// Noise hides what small neighbourhoods could tell: the first of 8, 12, 18 and 32 that it leaves.
// In a small neighbourhood a plane tilts by about noise / (2 radius), and these keep that below 15
// degrees.
std::size_t smallestScale(float noise) {
  if (noise >= 0.31F) return 3;
  if (noise >= 0.24F) return 2;
  return noise >= detail::kFewTellNothing ? 1 : 0;
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

// Without noise, densities say nothing: vertices of meshes have all of them.
bool looksLikeScan(const PointView& points, const Neighborhoods& nb, const NoiseLevel& noise,
                   const SheetNormalOptions& options) {
  return (noise.fine >= detail::kFewTellNothing && detail::isUneven(points, nb)) ||
         detail::showsScanLines(points, nb, options.threads);
}

}  // namespace

int detail::smallestNeighbors(float noise) {
  return kSheetScales[smallestScale(noise)];
}

SheetNormals estimateSheetNormals(const PointView& points, const Neighborhoods& nb,
                                  const SheetNormalOptions& options, detail::MoreNeighbors* more) {
  SheetNormals out;
  const std::size_t n = points.size;
  const NoiseLevel noise =
      options.known ? options.known->noise : measureNoise(points, nb, options.threads);
  out.traits.noise = noise;
  const std::size_t smallest = smallestScale(noise.fine);
  const int scale = kSheetScales[smallest];
  out.traits.scan_scales =
      options.known ? options.known->scan_scales
                    : !noise.thin &&
                          (options.scan_scales ||
                           (options.scan_lines && looksLikeScan(points, nb, noise, options))) &&
                          detail::needsScanScales(points, nb, scale, options.threads);
  if (more != nullptr && !out.traits.scan_scales) more->dropUnasked();
  out.normals.resize(4 * n);
  out.spacing.resize(n);
  out.curvature.resize(n);
  out.below.resize(n);
  out.above.resize(n);
  out.reliable.resize(n);
  std::vector<float> lopsided(n, std::numeric_limits<float>::infinity());
  parallelFor(n, options.threads, 30.0, [&](std::size_t i) {
    out.spacing[i] = detail::meanDistance(points, nb, i, detail::kFirstRing);
  });
  out.traits.lines = options.known ? options.known->lines : detail::seesLines({points, points, nb});
  std::vector<std::uint8_t> done;
  if (out.traits.scan_scales) {
    done.resize(n);
    detail::MoreNeighbors own(points, options.threads);
    detail::fitScanPlanes(more != nullptr ? *more : own, scale, options.threads,
                          [&](std::size_t i, const GrownPlanes& planes, std::size_t r) {
                            const Plane p = planes.at(r, out.spacing[i]);
                            store({p, p.variation(), {}, false}, i, out, lopsided);
                            done[i] = 1;
                          });
  }
  const FourFloats xyz(points);
  LocalFitJob all = jobOf(points, xyz, nb, kSheetNeighbors);
  all.same_points = true;
  const std::size_t blocks = (n + GrownPlanes::kRows - 1) / GrownPlanes::kRows;
  parallelFor(
      blocks, options.threads, timeOfEach(blocks, n, 2000.0),
      [] { return std::make_unique<SheetPlanes>(); },
      [&](std::size_t block, std::unique_ptr<SheetPlanes>& planes) {
        const std::size_t begin = block * GrownPlanes::kRows;
        std::vector<pcl::index_t> rows;
        for (std::size_t i = begin; i < std::min(n, begin + GrownPlanes::kRows); ++i) {
          if (done.empty() || done[i] == 0) rows.push_back(static_cast<pcl::index_t>(i));
        }
        LocalFitJob job = all;
        job.rows = rows.data();
        fitGrownPlanes(job, kSheetScales.data(), kSheetScales.size(), 0, rows.size(),
                       planes->data());
        std::vector<PointFit> fits;
        fits.reserve(rows.size());
        for (std::size_t r = 0; r < rows.size(); ++r) {
          const std::size_t i = job.row(r);
          Neighborhood of(points, nb, i, out.spacing[i], *planes, r, out.traits.lines);
          fits.push_back(fitPoint(of, smallest, noise, options));
        }
        if (options.split_walls) keepOwnWalls(job, out.spacing.data(), noise.thin, fits);
        for (std::size_t r = 0; r < rows.size(); ++r) store(fits[r], job.row(r), out, lopsided);
      });
  out.residual = options.known ? options.known->residual : medianResidual(out);
  out.traits.residual = out.residual;
  judgeReliability(lopsided, out);
  return out;
}

}  // namespace segorient
