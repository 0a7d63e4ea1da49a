// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sign_energy.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/dot.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "features/sheet_fit.h"
#include "orientation/automatic/blue_noise.h"
#include "orientation/automatic/even_cells.h"
#include "orientation/winding/dipole_fields.h"
#include "orientation/winding/winding_number.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

constexpr int kNearest = 8;               // neighbours that make pairs
constexpr std::size_t kPairRows = 20000;  // one pair in 10,000 is then some ten pairs
constexpr std::size_t kSamples = 2000;    // a share of the surface is known to about .01 then
// In distances to the sixth neighbour. A cell holds the layers of scans that are a spacing apart.
constexpr float kCell = 1.5F;

float distance(const float* a, const float* b) {
  float squares = 0.F;
  for (std::size_t i = 0; i < 3; ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares);
}

float medianSixth(const PointView& points, const Neighborhoods& table) {
  std::vector<float> distances;
  for (const std::size_t i : EveryNth(points.size, kPairRows)) {
    if (table.count(i) <= kFirstRing) continue;
    const auto q = static_cast<std::size_t>(table.indices(i)[kFirstRing]);
    distances.push_back(distance(points[i], points[q]));
  }
  return median(std::move(distances));
}

struct PairSums {
  float facing = 0.F;
  float backs = 0.F;
  int pairs = 0;

  void add(const float* p, const float* n, const float* q, const float* m) {
    ++pairs;
    const float opposed = -dot(n, m);
    if (!(opposed > 0.F)) return;
    const float d[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const float q_over_p = dot(d, n);
    const float p_over_q = -dot(d, m);
    if (q_over_p > 0.F && p_over_q > 0.F) facing += opposed;
    if (q_over_p < 0.F && p_over_q < 0.F) backs += opposed;
  }
};

}  // namespace

OpposedPairs opposedPairs(const PointView& points, const Neighborhoods& neighborhoods,
                          const std::vector<float>& normals, int threads) {
  const EveryNth rows(points.size, kPairRows);
  std::vector<PairSums> sums(rows.size());
  parallelFor(rows.size(), threads, 3000.0, [&](std::size_t r) {
    const std::size_t i = rows[r];
    const float* n = &normals[4 * i];
    if (!isFinite(n)) return;
    const int count = std::min(neighborhoods.count(i), kNearest + 1);
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(neighborhoods.indices(i)[j]);
      if (isFinite(&normals[4 * q])) sums[r].add(points[i], n, points[q], &normals[4 * q]);
    }
  });
  double facing = 0.0;
  double backs = 0.0;
  double pairs = 0.0;
  for (const PairSums& sum : sums) {
    facing += static_cast<double>(sum.facing);
    backs += static_cast<double>(sum.backs);
    pairs += sum.pairs;
  }
  if (pairs <= 0.0) return {};
  return {static_cast<float>(facing / pairs), static_cast<float>(backs / pairs)};
}

SignJudge::SignJudge(const PointView& points, const Neighborhoods& neighborhoods, int threads)
    : points_(points),
      neighborhoods_(neighborhoods),
      threads_(threads),
      sixth_(medianSixth(points, neighborhoods)),
      areas_(points.size, 0.F) {
  const BlueNoise cells = thinOut(points, kCell * sixth_, threads);
  if (cells.kept.empty()) return;
  std::vector<float> places(4 * cells.kept.size(), 0.F);
  for (std::size_t c = 0; c < cells.kept.size(); ++c) {
    std::copy_n(points[cells.kept[c]], 3, &places[4 * c]);
  }
  const PointView view{places.data(), 4, cells.kept.size()};
  Neighborhoods around;
  search::indexOf(view, threads).nearestKAll(7, around, false);
  std::vector<float> share(cells.kept.size(), 0.F);
  for (const std::uint32_t c : cells.cell_of) share[c] += 1.F;
  for (std::size_t c = 0; c < share.size(); ++c) {
    share[c] = cellArea(view, around, c) / share[c];
  }
  for (std::size_t i = 0; i < points.size; ++i) areas_[i] = share[cells.cell_of[i]];
  even_ = cells.kept;
}

float SignJudge::outsideAt(const std::vector<std::uint32_t>& rows,
                           const std::vector<float>& normals) const {
  const std::vector<float> dipoles = dipolesOf(normals, areas_);
  WindingNumber winding;
  winding.build(points_, dipoles.data(), {}, threads_);
  std::vector<float> in_front;
  for (const std::size_t k : EveryNth(rows.size(), kSamples)) {
    const std::size_t i = rows[k];
    const float* p = points_[i];
    const float* n = &normals[4 * i];
    if (!isFinite(n)) continue;
    const float far = kCell * sixth_;  // nearer, single cells stand out
    for (std::size_t a = 0; a < 3; ++a) in_front.push_back(p[a] + far * n[a]);
  }
  const std::size_t count = in_front.size() / 3;
  const std::vector<float> radii(count, sixth_);
  double sum = 0.0;
  for (const float w : winding.evaluate({in_front.data(), 3, count}, radii, threads_)) {
    sum += static_cast<double>(std::min(std::fabs(w), 0.5F));
  }
  return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.F;
}

SignEnergy SignJudge::judge(const std::vector<float>& normals) const {
  return {outsideAt(even_, normals), opposedPairs(points_, neighborhoods_, normals, threads_)};
}

}  // namespace segorient::detail
