// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/sheet_denoise.h"

#include <algorithm>
#include <cstddef>

#include "common/parallel_for.h"
#include "features/sheet_fit.h"

namespace segorient {

// A plane over k points of a slab thicker than their distance: 0.41 of the spacing at k = 8
// whatever the thickness, and 0.7 and more at k = 32 where the slab is thicker than a spacing.
bool needsDenoising(const NoiseLevel& noise) {
  return noise.fine > 0.36F && noise.coarse > 0.66F;
}

std::vector<float> projectOnPlanes(const PointView& points, const search::MedianHashIndex& index,
                                   int k, int threads) {
  std::vector<float> out(4 * points.size, 0.F);
  struct Near {
    std::vector<pcl::index_t> indices;
    std::vector<float> distances;
  };
  const auto room = static_cast<std::size_t>(std::max(k, 1));
  parallelFor(
      points.size, threads, 3000.0,
      [room] {
        return Near{std::vector<pcl::index_t>(room), std::vector<float>(room)};
      },
      [&](std::size_t i, Near& near) {
        const float* p = points[i];
        const int found = index.nearestK(p, k, near.indices.data(), near.distances.data());
        detail::Moments m;
        for (std::size_t j = 0; j < static_cast<std::size_t>(found); ++j) {
          const float* q = points[static_cast<std::size_t>(near.indices[j])];
          m.add(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
        }
        const detail::Plane plane = detail::fitPlane(m);
        const float shift = plane.valid ? plane.mean.dot(plane.normal) : 0.F;
        for (std::size_t a = 0; a < 3; ++a) {
          out[4 * i + a] = p[a] + shift * plane.normal[static_cast<Eigen::Index>(a)];
        }
      });
  return out;
}

}  // namespace segorient
