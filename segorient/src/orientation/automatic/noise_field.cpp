// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/noise_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/dot.h"
#include "common/median.h"
#include "features/sheet_fit.h"
#include "orientation/automatic/even_cells.h"
#include "orientation/winding/dipole_fields.h"
#include "orientation/winding/field_solver.h"

namespace segorient::detail {
namespace {

constexpr int kSix = 6;  // neighbours of the spacing
// In mean distances to the six nearest points. A cell holds about four points, whose mean has half
// the noise.
constexpr float kCell = 1.5F;
constexpr float kSmooth = 2.F;  // noise of a spacing is no more to the field than to its cells
// Less than that, as cells have averaged some of the noise, and fine parts are lost to a wide one.
constexpr float kFinal = 1.5F;

float medianSpacing(const PointView& points, const Neighborhoods& table) {
  constexpr std::size_t kRows = 20000;  // a median of so many is known to a hundredth
  const std::size_t stride = std::max<std::size_t>(1, points.size / kRows);
  std::vector<float> values;
  for (std::size_t i = 0; i < points.size; i += stride) {
    values.push_back(meanDistance(points, table, i, kSix));
  }
  return median(std::move(values));
}

struct Solution {
  std::vector<float> normals;  // of the subset
  FieldEnergy energy;
};

// Whether patches of another solution were taken for good: of an open sheet in noise the field
// makes a plate, whose sides are opposed, or what is in front of it.
bool isAllowed(const FieldEnergy& e, const FieldEnergy& own) {
  // Of a closed cloud .002 to .009 more (borders of the patches), of folded sheets .016 and more.
  constexpr float kOpposed = 0.012F;
  return e.outside <= own.outside && e.opposed <= own.opposed + kOpposed;
}

// Patches of neighbours where two solutions have opposed normals, by descending size.
std::vector<std::vector<std::uint32_t>> patchesOfDissent(const EvenCells& subset,
                                                         const std::vector<float>& a,
                                                         const std::vector<float>& b) {
  constexpr std::size_t kLeast = 6;  // fewer are noise
  std::vector<std::vector<std::uint32_t>> out;
  std::vector<std::uint8_t> open(subset.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = dot(&a[4 * i], &b[4 * i]) < 0.F ? 1 : 0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (open[i] == 0) continue;
    std::vector<std::uint32_t> patch{static_cast<std::uint32_t>(i)};
    open[i] = 0;
    for (std::size_t k = 0; k < patch.size(); ++k) {
      const std::size_t p = patch[k];
      for (int j = 1; j < subset.around.count(p); ++j) {
        const auto q = static_cast<std::size_t>(subset.around.indices(p)[j]);
        if (open[q] == 0 || !(dot(&a[4 * p], &a[4 * q]) > 0.F)) continue;
        open[q] = 0;
        patch.push_back(static_cast<std::uint32_t>(q));
      }
    }
    if (patch.size() < kLeast) continue;
    std::sort(patch.begin(), patch.end());
    out.push_back(std::move(patch));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& x, const auto& y) { return x.size() > y.size(); });
  return out;
}

// Takes over those patches of another solution that lower the spread.
void merge(const EvenCells& subset, const FieldSolver& solver, const std::vector<float>& other,
           Solution& best) {
  // What each of its points gains in the mean, of the 1/4 that one on the wrong side costs. -.02 to
  // .05 where closed clouds got worse, .07 to .8 where they got better.
  constexpr float kGain = 0.06F;
  constexpr std::size_t kMost = 40;  // each costs a sum over its points for all others
  const std::vector<std::vector<std::uint32_t>> patches =
      patchesOfDissent(subset, best.normals, other);
  if (patches.empty()) return;
  std::vector<float> winding = solver.windingOf(best.normals);
  float spread = solver.spreadOf(winding);
  std::vector<float> difference(4 * subset.size(), 0.F);
  std::vector<float> changed(winding.size());
  for (std::size_t p = 0; p < std::min(kMost, patches.size()); ++p) {
    for (const std::uint32_t i : patches[p]) {
      for (std::size_t a = 4 * std::size_t{i}; a < 4 * std::size_t{i} + 3; ++a) {
        difference[a] = other[a] - best.normals[a];
      }
    }
    const std::vector<float> change = solver.windingOf(difference, &patches[p]);
    for (std::size_t i = 0; i < changed.size(); ++i) changed[i] = winding[i] + change[i];
    const float with = solver.spreadOf(changed);
    const auto share = static_cast<float>(patches[p].size()) / static_cast<float>(subset.size());
    if (spread - with < kGain * share) {
      for (const std::uint32_t i : patches[p]) std::fill_n(&difference[4 * std::size_t{i}], 3, 0.F);
      continue;
    }
    spread = with;
    winding = changed;
    for (const std::uint32_t i : patches[p]) {
      std::copy_n(&other[4 * std::size_t{i}], 3, &best.normals[4 * std::size_t{i}]);
      std::fill_n(&difference[4 * std::size_t{i}], 3, 0.F);
    }
  }
}

}  // namespace

NoiseField findNoiseField(const PointView& points, const Neighborhoods& neighborhoods,
                          const std::vector<float>& normals, int threads) {
  // Spread: noise of a spacing alone makes so much, and with less no patch was wrong.
  constexpr float kSure = 0.03F;
  // Rounds: 12 and 5 gave the same.
  constexpr int kFromNothing = 8;
  constexpr int kFromBest = 3;
  constexpr float kLess = 0.97F;  // so that solutions that are equally good stay as they are
  const float spacing = medianSpacing(points, neighborhoods);
  EvenCells subset = gatherCells(points, normals, kCell * spacing, threads);
  NoiseField out;
  if (subset.size() == 0) return out;
  const FieldSolver solver(subset.points(), subset.around, subset.areas, kSmooth * spacing,
                           threads);
  const auto solution = [&](std::vector<float> of_subset) {
    const FieldEnergy energy = solver.energy(of_subset);
    return Solution{std::move(of_subset), energy};
  };
  const Solution own = solution(subset.normals);
  Solution best = own;
  if (own.energy.spread > kSure) {
    const std::vector<float> fresh =
        solver.relax(std::vector<float>(4 * subset.size(), 0.F), kFromNothing);
    Solution merged = own;
    merge(subset, solver, fresh, merged);
    merged.energy = solver.energy(merged.normals);
    if (merged.energy.spread < own.energy.spread && isAllowed(merged.energy, own.energy)) {
      best = std::move(merged);
    }
    Solution relaxed = solution(solver.relax(best.normals, kFromBest));
    if (relaxed.energy.spread < kLess * best.energy.spread &&
        isAllowed(relaxed.energy, own.energy)) {
      best = std::move(relaxed);
    }
  }
  solver.spreadOf(solver.windingOf(best.normals), &out.factor);
  out.dipoles = solver.dipolesOf(best.normals);
  out.radius = kFinal * spacing;
  // The signs as they came contradict the field by more than noise explains: the surface may be
  // open, or a wall whose two sides came out as one sheet, and which of them cannot be told.
  out.most = kSure / std::max(kSure, own.energy.spread);
  out.places = std::move(subset.places);
  return out;
}

// How steep the field is, by that of a plane without noise, limits the confidence: the two sides of
// a wall, and what is turned the wrong way around, take from it.
void takeNoiseField(const PointView& points, const NoiseField& field, int threads,
                    AutoNormals& found) {
  // Noise makes the field less steep everywhere; where it is .7 of a plane's and more, one normal
  // in 1,000 was wrong.
  constexpr float kSteep = 1.25F;
  if (field.empty()) return;
  const PointView places{field.places.data(), 4, field.places.size() / 4};
  const std::vector<float> falls =
      steepestDescents(points, {places, field.dipoles}, field.radius, threads);
  for (std::size_t i = 0; i < points.size; ++i) {
    float* n = &found.normals[4 * i];
    float& confidence = found.confidences[i];
    const float* g = &falls[4 * i];
    const float length = std::sqrt(dot(g, g));
    if (isFinite(n) && length > 0.F && std::isfinite(length)) {
      const float sign = dot(n, g) < 0.F ? -1.F : 1.F;
      float sum[3];
      for (std::size_t a = 0; a < 3; ++a) {
        sum[a] = sign * n[a] + (field.directions ? g[a] / length : 0.F);
      }
      const float total = std::sqrt(dot(sum, sum));
      for (std::size_t a = 0; a < 3; ++a) n[a] = sum[a] / total;
      // A plane's falls by 1 / (2 radius).
      const float steepness = 2.F * field.radius * field.factor * length;
      confidence = std::min(confidence, std::max(0.F, kSteep * steepness));
    }
    confidence = std::min(confidence, field.most);
  }
}

}  // namespace segorient::detail
