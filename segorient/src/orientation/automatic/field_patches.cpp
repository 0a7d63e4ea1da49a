// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/field_patches.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/at.h"
#include "common/box.h"
#include "common/disjoint_sets.h"
#include "common/dot.h"

namespace segorient::detail {
namespace {

using Rows = std::vector<std::uint32_t>;

// Cells that a mean of the field is of, two rings: of fewer the field tells nothing.
constexpr std::size_t kFewest = 25;
// On a surface w is 1/2, and so much more or less inside and outside.
constexpr float kOffSurface = 0.5F;

// Cells at which the two solutions are opposed, in patches that agree in themselves, by descending
// size.
std::vector<Rows> opposedPatches(const EvenCells& cells, const std::vector<float>& normals,
                                 const std::vector<float>& other) {
  const std::size_t n = cells.size();
  const auto opposed = [&](std::size_t c) { return dot(&normals[4 * c], &other[4 * c]) < 0.F; };
  DisjointSets sets(n);
  for (std::size_t c = 0; c < n; ++c) {
    if (!opposed(c)) continue;
    for (int j = 1; j < cells.around.count(c); ++j) {
      const auto q = static_cast<std::size_t>(cells.around.indices(c)[j]);
      if (!opposed(q) || !(dot(&normals[4 * c], &normals[4 * q]) > 0.F)) continue;
      sets.join(static_cast<std::int32_t>(c), static_cast<std::int32_t>(q));
    }
  }
  std::vector<Rows> patches(n);
  for (std::size_t c = 0; c < n; ++c) {
    if (!opposed(c)) continue;
    patches[at(sets.find(static_cast<std::int32_t>(c)))].push_back(static_cast<std::uint32_t>(c));
  }
  const auto small = [](const Rows& patch) { return patch.size() < kFewest; };
  patches.erase(std::remove_if(patches.begin(), patches.end(), small), patches.end());
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Rows& a, const Rows& b) { return a.size() > b.size(); });
  return patches;
}

// Cells as near to a patch as it is wide: farther away it is a dipole like any other.
Rows cellsAround(const PointView& points, const Rows& patch) {
  Box box;
  for (const std::uint32_t c : patch) box.add(points[c]);
  const float margin = box.diagonal();
  Rows near;
  for (std::size_t c = 0; c < points.size; ++c) {
    if (box.contains(points[c], margin)) near.push_back(static_cast<std::uint32_t>(c));
  }
  return near;
}

}  // namespace

bool contradictsField(const std::vector<float>& lack) {
  const auto beyond =
      std::count_if(lack.begin(), lack.end(), [](float v) { return std::fabs(v) > kOffSurface; });
  return static_cast<std::size_t>(beyond) >= kFewest;
}

std::vector<std::uint8_t> takeBetterPatches(const FieldSolver& solver, const EvenCells& cells,
                                            float factor, std::vector<float> lack,
                                            const std::vector<float>& other,
                                            std::vector<float>& normals) {
  const std::vector<Rows> patches = opposedPatches(cells, normals, other);
  if (patches.empty()) return {};
  std::vector<std::uint8_t> taken;
  std::vector<float> change(normals.size(), 0.F);
  for (const Rows& patch : patches) {
    double area = 0.0;
    for (const std::uint32_t c : patch) {
      area += static_cast<double>(cells.areas[c]);
      for (std::size_t at = 4 * std::size_t{c}, end = at + 3; at < end; ++at) {
        change[at] = other[at] - normals[at];
      }
    }
    const Rows near = cellsAround(cells.points(), patch);
    const std::vector<float> means = solver.meansNear(change, patch, near);
    double gain = 0.0;
    for (const std::uint32_t c : near) {
      const float after = lack[c] - factor * means[c];
      gain += static_cast<double>(cells.areas[c] * (lack[c] * lack[c] - after * after));
    }
    if (gain < static_cast<double>(kOffSurface * kOffSurface) * area) continue;
    taken.resize(cells.size(), 0);
    for (const std::uint32_t c : near) lack[c] -= factor * means[c];
    for (const std::uint32_t c : patch) {
      taken[c] = 1;
      std::copy_n(&other[4 * std::size_t{c}], 3, &normals[4 * std::size_t{c}]);
    }
  }
  return taken;
}

}  // namespace segorient::detail
