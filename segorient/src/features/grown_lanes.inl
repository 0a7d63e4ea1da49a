// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Planes of growing neighbourhoods for one instruction set; see lanes.inl.

#include "common/lanes.inl"

#include "features/plane_lanes.inl"
#include "features/sorting_lanes.inl"

// Of (lambda1 - lambda0) (lambda2 - lambda0), of a trace of 1: float leaves errors of 1e-4 rad
// then.
constexpr float kTellsDirection = 1e-3F;

inline void add(const Twice3& d, Scatter<Twice>& s) {
  s.sum = sum(s.sum, d);
  s.xx = s.xx + d.x * d.x;
  s.xy = s.xy + d.x * d.y;
  s.xz = s.xz + d.x * d.z;
  s.yy = s.yy + d.y * d.y;
  s.yz = s.yz + d.y * d.z;
  s.zz = s.zz + d.z * d.z;
}

/// The first `used` of two registers full.
inline void storeFirst(float* to, const Twice& a, std::size_t used) {
  if (used == kBatchRows) {
    store(to, a);
    return;
  }
  float all_of_them[kBatchRows];
  store(all_of_them, a);
  for (std::size_t l = 0; l < used; ++l) to[l] = all_of_them[l];
}

/// Brings offsets whose squares would over- or underflow to lengths around 1.
/// \return the units: lengths that are 1 now
inline Twice rescaleExtremes(Batch& batch) {
  const Twice ones = Twice{} + 1.0F;
  if (batch.first >= batch.count) return ones;
  const Twice3 farthest = batch.offsets(batch.count - 1);
  const Twice square = dot(farthest, farthest);
  if (!any((square < 1e-30F) | (square > 1e30F))) return ones;
  float of_lane[kBatchRows];
  for (std::size_t l = 0; l < kBatchRows; ++l) {
    rescalePoint(batch, l);
    of_lane[l] = static_cast<float>(batch.unit[l]);
  }
  return loadTwice(of_lane);
}

/// \param n of each point, itself counted \param unit of the offsets
inline void storePlanes(const Scatter<Twice>& s, const Twice& n, const Twice& unit, std::size_t at,
                        std::size_t used, GrownPlanes& out) {
  const Flattest<Twice> found = flattestDirection(s, n);
  const Twice zero{};
  const TwiceMask has_normal =
      (found.gap > kTellsDirection) & (dot(found.normal, found.normal) > 0.5F);
  // Where all variances are equal, what was found is not a number: the other operand remains.
  const Twice third = zero + 1.0F / 3.0F;
  const Twice least = larger(zero, smaller(select(has_normal, found.lambda, found.first), third));
  // The product of the other two, and their sum, are exact where their difference may not be.
  const Twice rest = 1.0F - least;
  const Twice product = larger(zero, found.minors - least * rest);
  const Twice root = squareRoot(larger(zero, rest * rest - 4.0F * product));
  const Twice most = 0.5F * (rest + root);
  const Twice nan = zero / zero;
  const Twice variance = select(found.trace > 0.0F, found.trace / n, nan);
  storeFirst(&out.lambda[0][at], least * variance, used);
  storeFirst(&out.lambda[1][at], product / most * variance, used);
  storeFirst(&out.lambda[2][at], most * variance, used);
  storeFirst(&out.normal[0][at], select(has_normal, found.normal.x, nan), used);
  storeFirst(&out.normal[1][at], select(has_normal, found.normal.y, nan), used);
  storeFirst(&out.normal[2][at], select(has_normal, found.normal.z, nan), used);
  storeFirst(&out.mean[0][at], s.sum.x / n, used);
  storeFirst(&out.mean[1][at], s.sum.y / n, used);
  storeFirst(&out.mean[2][at], s.sum.z / n, used);
  storeFirst(&out.n[at], n, used);
  storeFirst(&out.unit[at], unit, used);
}

void fitGrown(const LocalFitJob& job, const int* sizes, std::size_t count, std::size_t begin,
              std::size_t end, GrownPlanes* planes) {
  Batch batch(static_cast<std::size_t>(job.entries));
  for (std::size_t i = begin; i < end; i += kBatchRows) {
    loadBatch(job, i, end, batch);
    const std::size_t used = end - i < kBatchRows ? end - i : kBatchRows;
    const Twice counts = batch.allCounts();
    const Twice unit = rescaleExtremes(batch);
    Scatter<Twice> scatter{};
    int j = batch.first;
    for (std::size_t s = 0; s < count; ++s) {
      for (; j <= sizes[s] && j < batch.count; ++j) add(batch.offsets(j), scatter);
      const Twice n = smaller(counts, Twice{} + static_cast<float>(sizes[s] + 1));
      storePlanes(scatter, n, unit, i - begin, used, planes[s]);
    }
  }
}

/// See findMedians().
void mediansOf(const float* values, std::size_t count, float* medians) {
  for (std::size_t i = 0; i < GrownPlanes::kRows; i += kWidth) {
    // What is missing comes last.
    Lanes sorted[kMostMedian];
    Mask present{};
    for (std::size_t j = 0; j < kMostMedian; ++j) {
      sorted[j] = all(std::numeric_limits<float>::infinity());
      if (j >= count) continue;
      const Lanes v = load(values + j * GrownPlanes::kRows + i);
      present -= v == v;
      sorted[j] = select(v == v, v, sorted[j]);
    }
    sortLanes<kMostMedian>(sorted);
    const Mask half = present / 2;
    Lanes median = all(std::numeric_limits<float>::quiet_NaN());
    for (std::size_t j = 0; j <= kMostMedian / 2; ++j) {
      const Mask here = (half == static_cast<std::int32_t>(j)) & (present > 0);
      median = select(here, sorted[j], median);
    }
    store(medians + i, median);
  }
}
