// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/grazing_normals.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "common/dot.h"
#include "common/parallel_for.h"
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

Plane planeAround(const MoreNeighbors& more, std::size_t i) {
  const PointView& points = more.points();
  std::array<pcl::index_t, kAround + 1> row;
  const auto count = static_cast<std::size_t>(more.nearest(i, kAround + 1, row.data()));
  if (count < 3) return {};
  const float* p = points[i];
  const float* farthest = points[static_cast<std::size_t>(row[count - 1])];
  const std::array<float, 3> reach{farthest[0] - p[0], farthest[1] - p[1], farthest[2] - p[2]};
  const float radius = std::sqrt(dot(reach.data(), reach.data()));
  if (!(radius > 0.F)) return {};
  Moments m;
  for (std::size_t j = 0; j < count; ++j) {
    const float* q = points[static_cast<std::size_t>(row[j])];
    m.add((q[0] - p[0]) / radius, (q[1] - p[1]) / radius, (q[2] - p[2]) / radius);
  }
  return fitPlane(m);
}

}  // namespace

void replaceGrazingNormals(MoreNeighbors& more, const std::vector<float>& toward, int threads,
                           FilteredNormals& filtered) {
  std::vector<std::uint32_t> grazing;
  for (std::size_t i = 0; i < more.points().size; ++i) {
    const float* t = &toward[3 * i];
    const bool known = dot(t, t) > 0.F;
    if (known && std::fabs(dot(filtered.normals.data() + 4 * i, t)) < kLessLikely) {
      grazing.push_back(static_cast<std::uint32_t>(i));
    }
  }
  if (grazing.empty()) return;
  more.index();
  parallelFor(grazing.size(), threads, kQueryTime, [&](std::size_t g) {
    const std::size_t i = grazing[g];
    const Plane plane = planeAround(more, i);
    if (!plane.valid) return;
    float* n = filtered.normals.data() + 4 * i;
    const float seen = dot(plane.normal.data(), &toward[3 * i]);
    if (!(std::fabs(dot(n, &toward[3 * i])) < kLessLikely * std::fabs(seen))) return;
    for (std::size_t a = 0; a < 3; ++a) {
      n[a] = seen < 0.F ? -plane.normal.data()[a] : plane.normal.data()[a];
    }
  });
}

}  // namespace segorient::detail
