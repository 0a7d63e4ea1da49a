// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/scan_normals.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "features/scan_scale.h"
#include "features/sheet_normals.h"

namespace segorient::detail {
namespace {

std::size_t takeSheets(MoreNeighbors& more, const Neighborhoods& neighborhoods,
                       const SheetTraits& traits, int threads, std::vector<float>& normals) {
  SheetNormalOptions options;
  options.threads = threads;
  options.known = traits;
  const SheetNormals sheets = estimateSheetNormals(more.points(), neighborhoods, options, &more);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < sheets.curvature.size(); ++i) {
    if (!std::isfinite(sheets.normals[4 * i])) continue;
    std::copy_n(&sheets.normals[4 * i], 3, &normals[4 * i]);
    normals[4 * i + 3] = sheets.curvature[i];
    ++taken;
  }
  return taken;
}

}  // namespace

std::size_t takeScanPlanes(MoreNeighbors& more, const Neighborhoods& neighborhoods, int threads,
                           std::vector<float>& normals) {
  const PointView& points = more.points();
  const NoiseLevel noise = measureNoise(points, neighborhoods, threads);
  const int smallest = smallestNeighbors(noise.fine);
  if (noise.thin || !needsScanScales(points, neighborhoods, smallest, threads)) return 0;
  const SheetTraits traits{noise, 0.F, true};
  if (traits.onlyManyShowNoise()) return takeSheets(more, neighborhoods, traits, threads, normals);
  std::atomic<std::size_t> taken{0};
  fitScanPlanes(more, smallest, threads,
                [&](std::size_t i, const GrownPlanes& planes, std::size_t r) {
                  const Plane plane = planes.at(r);
                  if (!plane.valid) return;
                  std::copy_n(plane.normal.data(), 3, &normals[4 * i]);
                  normals[4 * i + 3] = plane.variation();
                  taken.fetch_add(1, std::memory_order_relaxed);
                });
  return taken;
}

}  // namespace segorient::detail
