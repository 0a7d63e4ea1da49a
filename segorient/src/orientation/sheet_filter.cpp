// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/threads.h>
#include <segorient/orientation/sheet_filter.h>

#include <algorithm>
#include <cmath>

namespace segorient {
namespace {

struct Kernel {
  float tolerance;  // of the distance to a plane, in spacings
  float residual;   // at which a plane counts half
};

struct Mean {
  float x = 0.F, y = 0.F, z = 0.F;
  float total = 0.F;
  float length() const { return std::sqrt(x * x + y * y + z * z); }
};

Mean meanNormal(const PointView& points, const Neighborhoods& nb, const std::vector<float>& normals,
                float h, std::size_t p, const Kernel& kernel) {
  const pcl::index_t* row = nb.indices(p);
  const float per_h = h > 0.F ? 1.F / h : 0.F;
  Mean mean;
  for (int j = 0; j < nb.count(p); ++j) {
    const auto q = static_cast<std::size_t>(row[j]);
    const float* n = normals.data() + 4 * q;
    if (!std::isfinite(n[0])) continue;
    const float dx = (points[q][0] - points[p][0]) * per_h;
    const float dy = (points[q][1] - points[p][1]) * per_h;
    const float dz = (points[q][2] - points[p][2]) * per_h;
    const float off = (dx * n[0] + dy * n[1] + dz * n[2]) / kernel.tolerance;
    const float fit = n[3] / kernel.residual;
    const float far2 = dx * dx + dy * dy + dz * dz;
    // Half weight at two spacings.
    const float w = std::exp(-0.5F * off * off) / ((1.F + fit * fit) * (1.F + 0.25F * far2));
    mean.x += w * n[0];
    mean.y += w * n[1];
    mean.z += w * n[2];
    mean.total += w;
  }
  return mean;
}

}  // namespace

FilteredNormals filterOrientedNormals(const PointView& points, const Neighborhoods& nb,
                                      const std::vector<float>& oriented,
                                      const std::vector<float>& spacing, float residual, int rounds,
                                      int threads) {
  // A tenth of a spacing is what curvature explains at one spacing's distance, beside the noise.
  const Kernel kernel{std::sqrt(0.01F + residual * residual), 0.03F + residual};
  FilteredNormals out;
  out.normals = oriented;
  out.confidences.assign(points.size, 0.F);
  std::vector<float> next;
  const int t = resolveThreads(threads);
  for (int round = 0; round < rounds; ++round) {
    next = out.normals;
#pragma omp parallel for num_threads(t) schedule(dynamic, 2048)
    for (std::size_t p = 0; p < points.size; ++p) {
      const Mean mean = meanNormal(points, nb, out.normals, spacing[p], p, kernel);
      const float l = mean.length();
      if (!(mean.total > 0.F) || !(l > 1e-4F * mean.total)) continue;
      float* n = next.data() + 4 * p;
      if (!std::isfinite(n[0])) n[3] = kernel.residual;
      n[0] = mean.x / l;
      n[1] = mean.y / l;
      n[2] = mean.z / l;
      out.confidences[p] = l / mean.total;
    }
    out.normals.swap(next);
  }
  return out;
}

}  // namespace segorient
