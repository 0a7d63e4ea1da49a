// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/grazing_normals.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "common/dot.h"
#include "common/threads.h"
#include "features/sheet_fit.h"

namespace segorient::detail {
namespace {

// The largest scale of normals on scans: a plane over so many is nearly free of noise.
constexpr int kAround = 60;
// Of two directions that explain a point, one is this much less likely to have been sampled: a
// third of the density.
constexpr float kLessLikely = 1.F / 3.F;
// ns a point, see resolveThreads().
constexpr double kQueryTime = 4000.0;

Plane planeAround(const PointView& points, const search::MedianHashIndex& index, std::size_t i) {
  std::array<pcl::index_t, kAround + 1> row;
  std::array<float, kAround + 1> distances;
  const int found = index.nearestK(points[i], kAround + 1, row.data(), distances.data(), 0.F);
  if (found < 3) return {};
  const float radius = std::sqrt(distances[static_cast<std::size_t>(found) - 1]);
  if (!(radius > 0.F)) return {};
  Moments m;
  const float* p = points[i];
  for (std::size_t j = 0; j < static_cast<std::size_t>(found); ++j) {
    const float* q = points[static_cast<std::size_t>(row[j])];
    m.add((q[0] - p[0]) / radius, (q[1] - p[1]) / radius, (q[2] - p[2]) / radius);
  }
  return fitPlane(m);
}

}  // namespace

void replaceGrazingNormals(const PointView& points, const std::vector<float>& toward, int threads,
                           FilteredNormals& filtered) {
  std::vector<std::uint32_t> grazing;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float* t = &toward[3 * i];
    const bool known = dot(t, t) > 0.F;
    if (known && std::fabs(dot(filtered.normals.data() + 4 * i, t)) < kLessLikely) {
      grazing.push_back(static_cast<std::uint32_t>(i));
    }
  }
  if (grazing.empty()) return;
  search::MedianHashIndex index;
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index.build(points, nullptr, options);
  const int t = resolveThreads(threads, grazing.size(), kQueryTime);
#pragma omp parallel for num_threads(t) schedule(dynamic, 64)
  for (std::size_t g = 0; g < grazing.size(); ++g) {
    const std::size_t i = grazing[g];
    const Plane plane = planeAround(points, index, i);
    if (!plane.valid) continue;
    float* n = filtered.normals.data() + 4 * i;
    const float seen = dot(plane.normal.data(), &toward[3 * i]);
    if (!(std::fabs(dot(n, &toward[3 * i])) < kLessLikely * std::fabs(seen))) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      n[a] = seen < 0.F ? -plane.normal.data()[a] : plane.normal.data()[a];
    }
  }
}

}  // namespace segorient::detail
