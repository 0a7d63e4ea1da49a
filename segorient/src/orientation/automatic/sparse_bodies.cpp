// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sparse_bodies.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/dot.h"
#include "common/median.h"
#include "orientation/automatic/even_cells.h"
#include "orientation/automatic/sign_energy.h"
#include "orientation/winding/consistent_normals.h"

namespace segorient::detail {
namespace {

// A neighbourhood of kSheetNeighbors is a hundredth of the surface and more.
constexpr std::size_t kFew = std::size_t{100} * kSheetNeighbors;
// Before an open surface |w| is a half, before a closed one nothing. With the normals that were
// found less than a half of that, as some may be wrong, and with those of the field of a quarter.
constexpr float kBeforeOpen = 0.5F;
constexpr float kMaybeClosed = kBeforeOpen / 2.F;
constexpr float kClosed = kBeforeOpen / 4.F;
// In spacings: from dipoles as wide as they are apart to such that the sides of a wall of a spacing
// are still apart.
constexpr ShrinkingRadius kRadius{1.F, 0.25F};
// Of the median area: points whose nearest are ten times as far away as usual are on no surface.
constexpr float kStray = 100.F;

// What the field finds.
struct Candidate {
  std::vector<float> normals;
  std::vector<float> confidences;
  SignEnergy energy;
};

// One a cell, 0 of strays.
std::vector<float> areasWithoutStrays(const EvenCells& cells) {
  std::vector<float> areas = cells.areas;
  const float most = kStray * median(areas);
  for (float& area : areas) area = area < most ? area : 0.F;
  return areas;
}

Candidate askField(const EvenCells& cells, const SignJudge& judge, int threads,
                   const AutoNormals& found) {
  const ShrinkingRadius radius{kRadius.first * found.spacing, kRadius.last * found.spacing};
  const ConsistentNormals field =
      consistentNormals(cells.points(), areasWithoutStrays(cells), radius, threads);
  Candidate out{found.normals, found.confidences, {}};
  for (std::size_t i = 0; i < cells.cell_of.size(); ++i) {
    const std::size_t cell = cells.cell_of[i];
    const float* normal = &field.normals[4 * cell];
    if (!(dot(normal, normal) > 0.F) || !isFinite(&found.normals[4 * i])) continue;
    std::copy_n(normal, 3, &out.normals[4 * i]);
    out.confidences[i] = std::clamp(field.steepness[cell], 0.F, 1.F);
  }
  out.energy = judge.judge(out.normals);
  return out;
}

}  // namespace

bool takeSparseField(const PointView& points, const Neighborhoods& neighborhoods, float noise,
                     int threads, AutoNormals& found) {
  if (points.size > kFew) return false;
  const SignJudge judge(points, neighborhoods, threads);
  const SignEnergy own = judge.judge(found.normals);
  if (!(own.outside < kMaybeClosed)) return false;
  // No two points are in one place, so that each is a cell of its own.
  const EvenCells cells = gatherCells(points, found.normals, 0.01F * found.spacing, threads);
  if (cells.size() == 0) return false;
  Candidate field = askField(cells, judge, threads, found);
  if (!(field.energy.outside < kClosed)) return false;
  // On walls thinner than a spacing the field folds, and contradicts itself far more than sheets
  // do. So it does in noise that takes points farther from the surface than the last radius; but
  // what looks like noise may be small parts, of which the field knows clearly more.
  const float most = noise > kRadius.last ? kClearlyLess : 2.F;
  if (field.energy.total() > most * own.total()) return false;
  found.normals = std::move(field.normals);
  found.confidences = std::move(field.confidences);
  return true;
}

}  // namespace segorient::detail
