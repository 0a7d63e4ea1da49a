// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/patch_signs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/at.h"
#include "common/dot.h"
#include "orientation/automatic/even_cells.h"
#include "orientation/automatic/patch_equations.h"
#include "orientation/automatic/sheet_signs.h"
#include "orientation/automatic/sign_energy.h"
#include "orientation/automatic/sign_patches.h"
#include "orientation/winding/dipole_fields.h"

namespace segorient::detail {
namespace {

struct CellScale {
  // In mean distances to the six nearest points: that cells are apart, and of the smoothing, over a
  // cell and its neighbours, so that no single dipole stands out.
  float cell, smooth;
  // The most of a surface that cells may see no plane of.
  float no_surface;
  // Signs are taken that have less than that share of the energy of those that there are.
  float less;
};
// Every second point or so is a cell, and a wall of two spacings keeps its sides apart. Bodies in
// contact have .03 without a plane (edges), walls of half a spacing, layers and outliers .1 and
// more: there, cells mix what the signs should tell apart.
constexpr CellScale kClean{0.8F, 1.F, 0.1F, kClearlyLess};
// Cells whose means have half the noise. Of nine clouds of bodies that touch or overlap, in noise
// of a quarter to half a spacing, the right signs have .1 to .62 of the energy of wrong ones. Signs
// that are right already had .69 and more: taken at .75 they lose .2 % at most, the signs of a
// single body at .83 would lose .8. Edges in noise, and patches that end for it, are a third of
// some clouds.
constexpr CellScale kNoisy{1.2F, 1.5F, 0.35F, 0.75F};
constexpr int kRounds = 5;  // each leaves out what the last one left undecided

bool isClosed(const std::vector<ComponentOrientationResult>& components) {
  double sum = 0.0;
  double points = 0.0;
  for (const ComponentOrientationResult& component : components) {
    const auto size = static_cast<double>(component.points);
    sum += size * static_cast<double>(std::min(1.F, component.residual));
    points += size;
  }
  return sum <= static_cast<double>(kClosedResidual) * points;
}

// Whether most of it is open ground with what stands on it, whose side is a convention whatever the
// winding number says: it bounds no bodies.
bool isGround(const AutoOrientation& orientation) {
  std::size_t ground = 0;
  std::size_t points = 0;
  for (std::size_t c = 0; c < orientation.ground.size(); ++c) {
    const ComponentOrientationResult& component = orientation.result.components[c];
    if (orientation.ground[c] != 0 && component.evidence >= kNoEvidence) ground += component.points;
    points += component.points;
  }
  return 2 * ground > points;
}

// Of each cell, the sign of its patch. Half of an undecided patch may lie outside of the contact:
// its cells look which way the field of all decided ones falls.
std::vector<float> signsOfCells(const EvenCells& cells, const SignPatches& patches,
                                const Signs& signs, float radius, int threads) {
  std::vector<float> out(cells.size(), 0.F);
  std::vector<float> dipoles(4 * cells.size(), 0.F);
  std::vector<float> at;
  std::vector<std::uint32_t> undecided;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (patches.of[c] >= 0) out[c] = static_cast<float>(signs[patches.of[c]]);
    const float* n = &cells.normals[4 * c];
    if (std::fabs(out[c]) > kDecided) {
      const float area = std::copysign(cells.areas[c], out[c]);
      for (std::size_t a = 0; a < 3; ++a) dipoles[4 * c + a] = area * n[a];
      dipoles[4 * c + 3] = cells.areas[c];
    } else {
      undecided.push_back(static_cast<std::uint32_t>(c));
      at.insert(at.end(), &cells.places[4 * c], &cells.places[4 * c] + 4);
    }
  }
  const std::vector<float> field = steepestDescents({at.data(), 4, undecided.size()},
                                                    {cells.points(), dipoles}, radius, threads);
  for (std::size_t k = 0; k < undecided.size(); ++k) {
    const std::size_t c = undecided[k];
    // A plane's falls by 1 / (2 radius).
    const float falls = 2.F * radius * dot(&field[4 * k], &cells.normals[4 * c]);
    if (std::isfinite(falls)) out[c] = std::clamp(out[c] + falls, -kDecided, kDecided);
  }
  return out;
}

// The sign of the nearest cell whose normal is that of the point; 0 if there is none around.
float signOf(const EvenCells& cells, const std::vector<float>& signs, const float* place,
             const float* normal, std::size_t cell) {
  constexpr float kAlike = 0.7F;  // 45 degrees
  float sign = 0.F;
  float least = std::numeric_limits<float>::max();
  for (int j = 0; j < cells.around.count(cell); ++j) {
    const auto c = static_cast<std::size_t>(cells.around.indices(cell)[j]);
    if (signs[c] == 0.F || dot(normal, &cells.normals[4 * c]) < kAlike) continue;
    float d[3];
    for (std::size_t a = 0; a < 3; ++a) d[a] = cells.places[4 * c + a] - place[a];
    if (dot(d, d) >= least) continue;
    least = dot(d, d);
    sign = signs[c];
  }
  return sign;
}

// The one solution from nothing; not allowed where cells do not make a surface.
PatchSolution solveFromNothing(const PatchEquations& equations, const CellScale& scale) {
  float surface = 0.F;
  for (const float share : equations.patches().areas) surface += share;
  if (equations.size() == 0 || surface < 1.F - scale.no_surface) return {};
  return equations.solve(Signs::Zero(static_cast<Eigen::Index>(equations.size())), 1);
}

// A coarse look at a large cloud, for a tenth of the time: open sheets bound no bodies, and in
// noise one that is right already is right to a coarse look, too.
bool mayBoundBodies(const PointView& points, const std::vector<float>& normals, float spacing,
                    bool noisy, int threads) {
  constexpr float kCoarse = 50000.F;  // cells
  const float size = std::sqrt(static_cast<float>(points.size) / kCoarse);
  const CellScale& scale = noisy ? kNoisy : kClean;
  if (size <= 2.F * scale.cell) return true;
  const float radius = size * spacing;
  const EvenCells cells = gatherCells(points, normals, radius, threads);
  const PatchEquations equations(cells, scale.smooth / scale.cell * radius, threads);
  const PatchSolution first = solveFromNothing(equations, scale);
  if (!noisy || !first.allowed) return first.allowed;
  return first.energy < scale.less * equations.judge(Signs::Ones(first.signs.size())).energy;
}

CellSigns findAtScale(const PointView& points, const std::vector<float>& normals, float spacing,
                      const CellScale& scale, int threads) {
  CellSigns out;
  out.cells = gatherCells(points, normals, scale.cell * spacing, threads);
  const float radius = scale.smooth * spacing;
  const PatchEquations equations(out.cells, radius, threads);
  const PatchSolution first = solveFromNothing(equations, scale);
  if (!first.allowed) return out;
  PatchSolution best;
  best.energy = scale.less * equations.judge(Signs::Ones(first.signs.size())).energy;
  for (const PatchSolution& other : {first, equations.solve(first.signs, kRounds - 1)}) {
    if (other.allowed && other.energy < best.energy) best = other;
  }
  if (!best.allowed) return out;
  out.signs = signsOfCells(out.cells, equations.patches(), best.signs, radius, threads);
  return out;
}

}  // namespace

CellSigns findCellSigns(const PointView& points, const std::vector<float>& normals, float spacing,
                        const AutoOrientation& orientation, bool noisy, int threads) {
  if (isClosed(orientation.result.components) || isGround(orientation)) return {};
  if (!mayBoundBodies(points, normals, spacing, noisy, threads)) return {};
  CellSigns out = findAtScale(points, normals, spacing, kClean, threads);
  if (noisy && out.empty()) out = findAtScale(points, normals, spacing, kNoisy, threads);
  return out;
}

bool contradictHints(const PointView& points, const CellSigns& cells,
                     const std::vector<float>& normals, const std::vector<std::int32_t>& components,
                     const std::vector<std::uint8_t>& inside_out, const PointHints& hints) {
  if (cells.empty() || (hints.seeds.empty() && hints.directions.empty())) return false;
  AutoNormals turned;
  turned.normals = normals;
  turned.confidences.assign(points.size, 1.F);
  takeCellSigns(points, cells, turned);
  double change = 0.0;
  const auto hear = [&](std::size_t i, const float* direction) {
    if (components[i] < 0) return;
    const float side = inside_out[at(components[i])] != 0 ? -1.F : 1.F;
    const float* n = &turned.normals[4 * i];
    change += static_cast<double>(side * (dot(n, direction) - dot(&normals[4 * i], direction)));
  };
  for (const PointHints::Seed& seed : hints.seeds) hear(seed.point, seed.normal.data());
  for (std::size_t i = 0; hints.seeds.empty() && i < points.size; ++i) {
    hear(i, &hints.directions[3 * i]);
  }
  return change < 0.0;
}

void takeCellSigns(const PointView& points, const CellSigns& cells, AutoNormals& found) {
  for (std::size_t i = 0; i < points.size && !cells.empty(); ++i) {
    float* n = &found.normals[4 * i];
    if (!std::isfinite(n[0])) continue;
    const float sign = signOf(cells.cells, cells.signs, points[i], n, cells.cells.cell_of[i]);
    found.confidences[i] = std::min(found.confidences[i], std::fabs(sign));
    if (sign >= 0.F) continue;
    for (std::size_t a = 0; a < 3; ++a) n[a] = -n[a];
  }
}

}  // namespace segorient::detail
