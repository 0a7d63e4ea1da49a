// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Means of the oriented normals around points, one point a lane, for one instruction set; see
// lanes.inl.

#include "common/lanes.inl"

struct MeanSums {
  Lanes3 normal;
  Lanes total;
};

/// Adds each point's j-th neighbour. \param kAll all of them have one
template <bool kAll>
inline void addNeighbor(const NormalsAround& around, const MeanBlock& block, std::size_t at,
                        std::size_t j, const Lanes3& own, Lanes per_h, MeanSums& sums) {
  const float* points[kWidth];
  const float* normals[kWidth];
  for (std::size_t l = 0; l < kWidth; ++l) {
    const std::size_t entry = kAll || j < block.counts[at + l] ? j : 0;
    const auto q = static_cast<std::size_t>(block.rows[at + l][entry]);
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
  Mask counts = n.x - n.x == Lanes{};  // no NaN, not infinite
  if constexpr (!kAll) {
    for (std::size_t l = 0; l < kWidth; ++l) {
      if (j >= block.counts[at + l]) counts[l] = 0;
    }
  }
  sums.normal = sum(sums.normal, select(counts, scaled(n, w), Lanes3{}));
  sums.total = sums.total + select(counts, w, Lanes{});
}

inline void findMeans(const NormalsAround& around, MeanBlock& block) {
  for (std::size_t at = 0; at < MeanBlock::kPoints; at += kWidth) {
    const Lanes3 own = loadPoints(&block.own[at]);
    const Lanes per_h = load(&block.per_h[at]);
    MeanSums sums{};
    std::size_t j = 0;
    for (; j < block.least; ++j) addNeighbor<true>(around, block, at, j, own, per_h, sums);
    for (; j < block.most; ++j) addNeighbor<false>(around, block, at, j, own, per_h, sums);
    store(&block.mean_x[at], sums.normal.x);
    store(&block.mean_y[at], sums.normal.y);
    store(&block.mean_z[at], sums.normal.z);
    store(&block.total[at], sums.total);
  }
}
