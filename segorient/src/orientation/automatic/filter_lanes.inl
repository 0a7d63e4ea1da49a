// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Means of the oriented normals around points, one point a lane, for one instruction set; see
// lanes.inl.

#include "common/lanes.inl"

inline void addNeighbors(const NormalsAround& around, MeanBlock& block, std::size_t at) {
  const Lanes3 own = loadPoints(&block.own[at]);
  const Lanes per_h = load(&block.per_h[at]);
  const Lanes counts = load(&block.counts[at]);
  Lanes3 sums{};
  Lanes total{};
  for (std::size_t j = 0; j < block.most; ++j) {
    const float* points[kWidth];
    const float* normals[kWidth];
    for (std::size_t l = 0; l < kWidth; ++l) {
      const pcl::index_t* const row = block.rows[at + l];
      const auto q = static_cast<std::size_t>(row[static_cast<float>(j) < counts[l] ? j : 0]);
      points[l] = around.xyz + 4 * q;
      normals[l] = around.normals + 4 * q;
    }
    Lanes residual;
    const Lanes3 n = loadRows(normals, residual);
    const Lanes3 d = scaled(difference(loadPoints(points), own), per_h);
    const Lanes off = dot(d, n) * around.inverse_tolerance;
    const Lanes fit = residual * around.inverse_residual;
    // A Gaussian of the offset, to a few hundredths: (1 + t / 16)^16 for exp(t).
    const Lanes base = 1.F + off * off * (0.5F / 16.F);
    const Lanes base2 = base * base;
    const Lanes base4 = base2 * base2;
    const Lanes base8 = base4 * base4;
    // Half weight at two spacings.
    const Lanes w = 1.F / (base8 * base8 * (1.F + fit * fit) * (1.F + 0.25F * dot(d, d)));
    const Mask counted = (all(static_cast<float>(j)) < counts) & (n.x == n.x);
    sums = sum(sums, select(counted, scaled(n, w), Lanes3{}));
    total = total + select(counted, w, Lanes{});
  }
  store(&block.mean_x[at], sums.x);
  store(&block.mean_y[at], sums.y);
  store(&block.mean_z[at], sums.z);
  store(&block.total[at], total);
}

inline void findMeans(const NormalsAround& around, MeanBlock& block) {
  for (std::size_t at = 0; at < MeanBlock::kPoints; at += kWidth) addNeighbors(around, block, at);
}
