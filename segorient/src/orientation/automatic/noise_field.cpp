// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/noise_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "common/dot.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "features/sheet_fit.h"
#include "orientation/automatic/even_cells.h"
#include "orientation/automatic/field_patches.h"
#include "orientation/automatic/sign_energy.h"
#include "orientation/automatic/torn_sheets.h"
#include "orientation/winding/dipole_fields.h"
#include "orientation/winding/field_solver.h"

namespace segorient::detail {
namespace {

// Of so many points a median is known to a hundredth, a kurtosis to less than a tenth.
constexpr std::size_t kRows = 20000;

float medianSpacing(const PointView& points, const Neighborhoods& table) {
  std::vector<float> values;
  for (const std::size_t i : EveryNth(points.size, kRows)) {
    values.push_back(meanDistance(points, table, i, kFirstRing));
  }
  return median(std::move(values));
}

// Of each cell, how much the signs of its normals are to be believed. One that is right with
// (1 + c) / 2 is c times itself in the mean, with the square of which it counts.
// \param wanted mean, by area
std::vector<float> trustOf(const EvenCells& cells, const std::vector<float>& confidences,
                           float wanted) {
  std::vector<float> sums(cells.size(), 0.F);
  std::vector<float> counts(cells.size(), 0.F);
  for (std::size_t i = 0; i < confidences.size(); ++i) {
    sums[cells.cell_of[i]] += confidences[i];
    counts[cells.cell_of[i]] += 1.F;
  }
  double area = 0.0;
  double trust = 0.0;
  for (std::size_t c = 0; c < sums.size(); ++c) {
    const float mean = counts[c] > 0.F ? sums[c] / counts[c] : 1.F;
    sums[c] = mean * mean;
    area += static_cast<double>(cells.areas[c]);
    trust += static_cast<double>(cells.areas[c] * sums[c]);
  }
  if (!(trust > 0.0)) return std::vector<float>(cells.size(), wanted);
  const double factor = static_cast<double>(wanted) * area / trust;
  for (float& v : sums) v = static_cast<float>(factor * static_cast<double>(v));
  return sums;
}

// How far a point is off the mean of its neighbours on the same side, along its normal; NaN where
// there are few.
float offsetOf(const PointView& points, const Neighborhoods& table,
               const std::vector<float>& normals, std::size_t i) {
  const float* n = &normals[4 * i];
  float sum = 0.F;
  int same = 0;
  for (int j = 1; j < table.count(i); ++j) {
    const auto q = static_cast<std::size_t>(table.indices(i)[j]);
    if (!(dot(n, &normals[4 * q]) > 0.F)) continue;
    const float d[3] = {points[q][0] - points[i][0], points[q][1] - points[i][1],
                        points[q][2] - points[i][2]};
    sum += dot(d, n);
    ++same;
  }
  const bool enough = 2 * same >= table.count(i) - 1 && same > 0;
  return enough ? sum / static_cast<float>(same) : std::numeric_limits<float>::quiet_NaN();
}

// Whether what came out as one sheet are the two sides of a wall. The offsets of noise are normally
// distributed, or have longer tails where surfaces bend; those of two sides a to the left and right
// with noise s have an excess kurtosis of -2 a^4 / (a^2 + s^2)^2.
bool hidesTwoSides(const PointView& points, const Neighborhoods& table,
                   const std::vector<float>& normals, int threads) {
  // Half of what sides make that are as far from their middle as noise takes points.
  constexpr double kTwoSides = -0.25;
  const EveryNth rows(points.size, kRows);
  std::vector<float> offsets(rows.size());
  parallelFor(offsets.size(), threads, 300.0,
              [&](std::size_t r) { offsets[r] = offsetOf(points, table, normals, rows[r]); });
  double count = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  for (const float offset : offsets) {
    if (!std::isfinite(offset)) continue;
    const double square = static_cast<double>(offset) * static_cast<double>(offset);
    count += 1.0;
    squares += square;
    fourths += square * square;
  }
  return squares > 0.0 && count * fourths / (squares * squares) - 3.0 < kTwoSides;
}

// 4 floats a point: how the field falls there.
std::vector<float> fallsOf(const PointView& points, const NoiseField& field, int threads) {
  return steepestDescents(points, {field.points(), field.dipoles}, field.radius, threads);
}

// What the field says of points.
struct FieldSides {
  std::vector<float> falls;           ///< see fallsOf()
  std::vector<std::uint8_t> against;  ///< whether it falls the other way than the normal

  FieldSides(const PointView& points, const NoiseField& field, const std::vector<float>& normals,
             int threads)
      : falls(fallsOf(points, field, threads)), against(points.size, 0) {
    for (std::size_t i = 0; i < points.size; ++i) {
      against[i] = dot(&normals[4 * i], &falls[4 * i]) < 0.F ? 1 : 0;
    }
  }
};

// Of the points that the field is against, those that are to be turned.
std::vector<std::uint8_t> pointsToTurn(const PointView& points, const Neighborhoods& neighborhoods,
                                       const NoiseField& field, const std::vector<float>& normals,
                                       const std::vector<std::uint8_t>& against, int threads) {
  std::vector<std::uint8_t> turned = against;
  if (!field.consistent) return turned;
  const bool whole = field.keeps.empty();
  if (whole) keepSheetsWhole(neighborhoods, normals, turned);
  const std::vector<std::uint8_t>& told = whole ? field.turns : field.keeps;
  if (told.empty()) return turned;
  const std::vector<std::uint32_t> cells = nearestCells(points, field.points(), threads);
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (against[i] != 0 && told[cells[i]] != 0) turned[i] = whole ? 1 : 0;
  }
  return turned;
}

// An even subset, the solver on it, and how well its normals fit as they came.
struct SolvedCells {
  EvenCells cells;
  FieldSolver solver;
  FieldFit own;

  SolvedCells(const PointView& points, const std::vector<float>& normals, float spacing,
              const FieldScale& scale, int threads)
      : cells(gatherCells(points, normals, scale.cell * spacing, threads)),
        solver(cells.points(), cells.around, cells.areas, scale.smooth * spacing, threads),
        own(cells.size() > 0 ? solver.fit(cells.normals) : FieldFit{}) {}
};

// In spacings: the least radius of the smoothing that noise allows, from what it leaves of w over
// kNoisyField. Smaller ones keep finer parts apart, larger ones average more of the noise.
float radiusFor(float spread) {
  // Of the radius, as far as noise may take the means of cells. With .8 round bodies in noise of
  // three spacings lose 1 %, with .5 thin parts in less noise lose .2.
  constexpr float kMost = 0.65F;
  // Cells of fewer than two points, three quarters of that apart, would average nothing.
  constexpr float kLeast = 1.2F;
  // A plane's points that are normally distributed about it, by q radii: the mean square of
  // w - 1/2 is q / 10 - .01 to .002, for q from .2 to 1.
  const float noise = 0.1F + 10.F * spread;
  return std::clamp(kNoisyField.smooth * noise / kMost, kLeast, kNoisyField.smooth);
}

}  // namespace

void findWhatSheetsKeep(const PointView& points, const Neighborhoods& neighborhoods,
                        const std::vector<float>& normals, int threads, NoiseField& field) {
  if (field.empty() || !field.consistent) return;
  const std::vector<std::uint8_t> against = FieldSides(points, field, normals, threads).against;
  const std::vector<std::uint8_t> turned =
      pointsToTurn(points, neighborhoods, field, normals, against, threads);
  const std::vector<std::uint32_t> cells = nearestCells(points, field.points(), threads);
  std::vector<int> balance(field.places.size() / 4, 0);
  for (std::size_t i = 0; i < against.size(); ++i) {
    if (against[i] != 0) balance[cells[i]] += turned[i] != 0 ? -1 : 1;
  }
  for (const int b : balance) field.keeps.push_back(b > 0 ? 1 : 0);
}

NoiseField findNoiseField(const PointView& points, const Neighborhoods& neighborhoods,
                          const std::vector<float>& normals, int threads,
                          const std::vector<float>& confidences, std::optional<KnownField> known,
                          FieldScale scale) {
  // Spread, at the scale that was asked for: noise of a spacing alone makes so much.
  constexpr float kSure = 0.03F;
  // The mean of w is a fifth of its root mean square there, as it is by chance of 25 pieces with
  // random signs: the surface is open, for all that w tells. Folds and rolls have three quarters.
  constexpr float kSaysNothing = 0.24F;
  // Half of the mean square of w is that of its mean: most of the surface is closed and right, so
  // that what w contradicts is wrong. On open sheets it contradicts what is right.
  constexpr float kSaysMost = 0.125F;
  // The spread is what noise leaves of w; over it, and the square of what noise leaves of normals,
  // a half. 1 and 4 are as good in the mean.
  constexpr float kEvidence = 2.F;
  const float spacing = medianSpacing(points, neighborhoods);
  NoiseField out;
  if (!(spacing > 0.F)) return out;  // one place
  if (!known) {
    const OpposedPairs pairs = opposedPairs(points, neighborhoods, normals, threads);
    // Where no neighbours have their faces or their backs to each other, nothing is that thin.
    known = KnownField{pairs.facing < kSuspicious, pairs.facing + pairs.backs >= kSuspicious};
  }
  out.consistent = known->consistent;
  out.fine = known->fine;
  // What single points show of two sides are their own lines.
  const bool averaged = scale.cell > 1.F;
  auto field = std::make_unique<SolvedCells>(points, normals, spacing, scale, threads);
  const float spread = field->own.spread;
  const float radius = averaged && out.fine ? radiusFor(spread) : scale.smooth;
  if (radius < scale.smooth) {
    scale = scale.times(radius / scale.smooth);
    field = std::make_unique<SolvedCells>(points, normals, spacing, scale, threads);
  }
  EvenCells& subset = field->cells;
  if (subset.size() == 0) return out;
  const FieldSolver& solver = field->solver;
  const FieldFit own = field->own;
  std::vector<float> found = subset.normals;
  if (own.spread < kSaysNothing && own.factor > 0.F) {
    std::vector<float> lack;
    if (averaged && own.spread < kSaysMost) lack = solver.lackOf(found, own.factor);
    if (contradictsField(lack)) {
      const std::vector<float> nothing(found.size(), 0.F);
      const std::vector<float> even(subset.size(), kEvidence * own.spread);
      out.turns = takeBetterPatches(solver, subset, own.factor, std::move(lack),
                                    solver.solve(nothing, even), found);
    }
    // Signs that do not contradict each other are all as good, whatever votes were against them.
    const std::vector<float> trust = trustOf(
        subset, out.consistent ? std::vector<float>{} : confidences, kEvidence * own.spread);
    // What the first solution found is the evidence of the second; a third changes little.
    found = solver.solve(solver.solve(found, trust), trust);
  }
  out.factor = solver.fit(found).factor;
  out.dipoles = dipolesOf(found, subset.areas);
  out.radius = scale.last * spacing;
  // The signs as they came contradict the field by more than noise explains: the surface may be
  // open, or a wall whose two sides came out as one sheet, and which of them cannot be told.
  out.most = kSure / std::max(kSure, spread);
  if (averaged && hidesTwoSides(points, neighborhoods, normals, threads)) out.most = 0.F;
  out.places = std::move(subset.places);
  return out;
}

// How steep the field is, by that of a plane without noise, limits the confidence: the two sides of
// a wall, and what is turned the wrong way around, take from it.
void takeNoiseField(const PointView& points, const Neighborhoods& neighborhoods,
                    const NoiseField& field, int threads, AutoNormals& found) {
  // Noise makes the field less steep everywhere; where it is .7 of a plane's and more, one normal
  // in 1,000 was wrong.
  constexpr float kSteep = 1.25F;
  if (field.empty()) return;
  const FieldSides sides(points, field, found.normals, threads);
  const std::vector<std::uint8_t> turned =
      pointsToTurn(points, neighborhoods, field, found.normals, sides.against, threads);
  for (std::size_t i = 0; i < points.size; ++i) {
    float* n = &found.normals[4 * i];
    float& confidence = found.confidences[i];
    const float* g = &sides.falls[4 * i];
    const float length = std::sqrt(dot(g, g));
    if (isFinite(n) && length > 0.F && std::isfinite(length)) {
      const float sign = turned[i] != 0 ? -1.F : 1.F;
      const bool averaged =
          turned[i] == sides.against[i] && sign * dot(n, g) < field.averaged_below * length;
      float sum[3];
      for (std::size_t a = 0; a < 3; ++a) {
        sum[a] = sign * n[a] + (averaged ? g[a] / length : 0.F);
      }
      const float total = std::sqrt(dot(sum, sum));
      for (std::size_t a = 0; total > 0.F && a < 3; ++a) n[a] = sum[a] / total;
      // A plane's falls by 1 / (2 radius).
      const float steepness = 2.F * field.radius * field.factor * length;
      confidence = std::min(confidence, std::max(0.F, kSteep * steepness));
    }
    confidence = std::min(confidence, field.most);
  }
}

void takeFieldLines(const PointView& points, const NoiseField& field, int threads,
                    std::vector<float>& normals) {
  if (field.empty()) return;
  const std::vector<float> falls = fallsOf(points, field, threads);
  for (std::size_t i = 0; i < points.size; ++i) {
    float* n = &normals[4 * i];
    const float* g = &falls[4 * i];
    const float length = std::sqrt(dot(g, g));
    if (!std::isfinite(length)) continue;
    const float along = dot(n, g);
    if (!(along > 0.F && along < kAcross * length)) continue;
    for (std::size_t a = 0; a < 3; ++a) n[a] = g[a] / length;
  }
}

NoiseField takeFineField(const PointView& points, const Neighborhoods& neighborhoods, int threads,
                         AutoNormals& found) {
  NoiseField field = findNoiseField(points, neighborhoods, found.normals, threads,
                                    found.confidences, KnownField{}, kFineField);
  if (field.empty() || field.most < 1.F) return {};
  field.averaged_below = kAcross;
  AutoNormals other;
  other.normals = found.normals;
  other.confidences = found.confidences;
  takeNoiseField(points, neighborhoods, field, threads, other);
  const SignJudge judge(points, neighborhoods, threads);
  if (!(judge.judge(other.normals).total() < judge.judge(found.normals).total())) return {};
  found.normals = std::move(other.normals);
  found.confidences = std::move(other.confidences);
  return field;
}

}  // namespace segorient::detail
