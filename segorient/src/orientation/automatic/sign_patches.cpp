// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sign_patches.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/dot.h"

namespace segorient::detail {
namespace {

constexpr float kCosine = 0.9F;  // 25 degrees: more is an edge, or another sheet that crosses
constexpr float kOffPlane =
    0.3F;  // 17 degrees: what such a curve leaves, and no gap between sheets
constexpr std::size_t kCells = 80;  // some nine across: a few of its borders' lengths
constexpr std::size_t kFull = 500;  // patches of full size: their normal equations take .1 s
constexpr std::size_t kLeast = 4;   // cells that make a piece of surface

// The distance of a place from a cell's plane, as a share of the distance between both.
float offPlane(const EvenCells& cells, std::size_t cell, std::size_t other) {
  const PointView places = cells.points();
  float d[3];
  for (std::size_t a = 0; a < 3; ++a) d[a] = places[other][a] - places[cell][a];
  const float length = std::sqrt(dot(d, d));
  return length > 0.F ? std::fabs(dot(d, &cells.normals[4 * cell])) / length : 0.F;
}

// Whether half of the cells around lie on its plane, as they do at an edge; of points that lie
// anywhere three in ten do.
bool isSurface(const EvenCells& cells, std::size_t i) {
  const int count = cells.around.count(i) - 1;
  int on_plane = 0;
  for (int j = 1; j <= count; ++j) {
    const auto q = static_cast<std::size_t>(cells.around.indices(i)[j]);
    if (offPlane(cells, i, q) <= kOffPlane) ++on_plane;
  }
  return 2 * on_plane >= count && count > 0;
}

std::vector<std::uint32_t> growFrom(const EvenCells& cells, std::size_t first, std::size_t most,
                                    std::vector<std::uint8_t>& taken) {
  std::vector<std::uint32_t> patch{static_cast<std::uint32_t>(first)};
  taken[first] = 1;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const std::size_t i = patch[k];
    for (int j = 1; j < cells.around.count(i) && patch.size() < most; ++j) {
      const auto q = static_cast<std::size_t>(cells.around.indices(i)[j]);
      if (taken[q] != 0 || !(dot(&cells.normals[4 * i], &cells.normals[4 * q]) > 0.F)) continue;
      if (!goesOn(cells, i, q)) continue;
      taken[q] = 1;
      patch.push_back(static_cast<std::uint32_t>(q));
    }
  }
  std::sort(patch.begin(), patch.end());
  return patch;
}

std::vector<PatchBorder> findBorders(const EvenCells& cells, const SignPatches& patches,
                                     float area) {
  std::vector<PatchBorder> pairs;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (patches.of[i] < 0) continue;
    for (int j = 1; j < cells.around.count(i); ++j) {
      const auto q = static_cast<std::size_t>(cells.around.indices(i)[j]);
      if (patches.of[q] < 0 || patches.of[q] == patches.of[i] || !goesOn(cells, i, q)) continue;
      const auto ends = std::minmax(patches.of[i], patches.of[q]);
      // Most pairs are seen from both ends.
      const float share = 0.5F * cells.areas[i] / area;
      const bool alike = dot(&cells.normals[4 * i], &cells.normals[4 * q]) > 0.F;
      pairs.push_back({static_cast<std::uint32_t>(ends.first),
                       static_cast<std::uint32_t>(ends.second), alike ? share : -share});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const PatchBorder& x, const PatchBorder& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  std::vector<PatchBorder> out;
  for (const PatchBorder& pair : pairs) {
    if (out.empty() || out.back().a != pair.a || out.back().b != pair.b) {
      out.push_back(pair);
    } else {
      out.back().agreement += pair.agreement;
    }
  }
  return out;
}

}  // namespace

bool goesOn(const EvenCells& cells, std::size_t i, std::size_t q) {
  const float* n = &cells.normals[4 * i];
  const float* m = &cells.normals[4 * q];
  if (!(std::fabs(dot(n, m)) > kCosine)) return false;
  return offPlane(cells, i, q) <= kOffPlane && offPlane(cells, q, i) <= kOffPlane;
}

SignPatches growPatches(const EvenCells& cells) {
  SignPatches out;
  out.of.assign(cells.size(), -1);
  const std::size_t most = std::max(kCells, cells.size() / kFull);
  double sum = 0.0;
  for (const float a : cells.areas) sum += static_cast<double>(a);
  const auto area = static_cast<float>(sum);
  std::vector<std::uint8_t> taken(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) taken[i] = isSurface(cells, i) ? 0 : 1;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (taken[i] != 0) continue;
    std::vector<std::uint32_t> patch = growFrom(cells, i, most, taken);
    if (patch.size() < kLeast) continue;
    float share = 0.F;
    for (const std::uint32_t c : patch) {
      out.of[c] = static_cast<std::int32_t>(out.size());
      share += cells.areas[c] / area;
    }
    out.cells.push_back(std::move(patch));
    out.areas.push_back(share);
  }
  out.borders = findBorders(cells, out, area);
  return out;
}

float brokenShare(const EvenCells& cells, const std::vector<float>& normals) {
  std::size_t broken = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (int j = 1; j < cells.around.count(i); ++j) {
      const auto q = static_cast<std::size_t>(cells.around.indices(i)[j]);
      ++pairs;
      if (dot(&normals[4 * i], &normals[4 * q]) < 0.F && goesOn(cells, i, q)) ++broken;
    }
  }
  return pairs > 0 ? static_cast<float>(broken) / static_cast<float>(pairs) : 0.F;
}

}  // namespace segorient::detail
