// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/winding_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/threads.h"
#include "orientation/winding/winding_number.h"

namespace segorient {
namespace {

constexpr float kHuge = std::numeric_limits<float>::max();
constexpr float kNothingToMend = 0.97F;  // confidence from which on there is nothing to mend
// Median residual, in spacings, above which it is noise: curvature alone leaves some hundredths.
// Noise makes the planes in the tip of a wedge lie between its faces, where they agree with each
// other, wrongly; below, the planes near an edge are of one face each.
constexpr float kNoisy = 0.1F;

std::vector<std::uint32_t> listDoubtful(const std::vector<float>& spacing,
                                        const FilteredNormals& filtered) {
  std::vector<std::uint32_t> rows;
  for (std::size_t p = 0; p < spacing.size(); ++p) {
    if (filtered.confidences[p] >= kNothingToMend || !std::isfinite(filtered.normals[4 * p]))
      continue;
    if (spacing[p] > 0.F) rows.push_back(static_cast<std::uint32_t>(p));
  }
  return rows;
}

// Areas in a unit of their own: the direction of the field is all that is wanted.
std::vector<float> dipolesOf(const std::vector<float>& spacing, const FilteredNormals& filtered) {
  std::vector<float> dipoles(4 * spacing.size(), 0.F);
  for (std::size_t p = 0; p < spacing.size(); ++p) {
    if (!std::isfinite(filtered.normals[4 * p])) continue;
    const float area = std::isfinite(spacing[p]) ? spacing[p] * spacing[p] : 0.F;
    for (std::size_t a = 0; a < 3; ++a) dipoles[4 * p + a] = area * filtered.normals[4 * p + a];
    dipoles[4 * p + 3] = area;
  }
  return dipoles;
}

// Doubtful points that are near each other share the dipoles that they see.
struct Run {
  std::size_t first;
  std::size_t last;
};

bool areNear(const float* a, const float* b, float reach) {
  float squares = 0.F;
  for (std::size_t i = 0; i < 3; ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return squares <= reach * reach;
}

std::vector<Run> cutRuns(const PointView& points, const std::vector<float>& spacing,
                         const std::vector<std::uint32_t>& rows) {
  constexpr std::uint32_t kRows = 16;  // of the cloud's order, which jumps here and there
  constexpr float kReach = 8.F;        // in spacings
  std::vector<Run> runs;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t first = runs.empty() ? k : runs.back().first;
    const float* start = points[rows[first]];
    if (runs.empty() || rows[k] - rows[first] >= kRows ||
        !areNear(start, points[rows[k]], kReach * spacing[rows[first]])) {
      runs.push_back({k, k});
    }
    runs.back().last = k + 1;
  }
  return runs;
}

void listDipolesOf(const WindingNumber& field, const PointView& points,
                   const std::vector<std::uint32_t>& rows, const Run& run, DipoleList& out) {
  std::array<float, 3> low{kHuge, kHuge, kHuge};
  std::array<float, 3> high{-kHuge, -kHuge, -kHuge};
  for (std::size_t k = run.first; k < run.last; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], points[rows[k]][a]);
      high[a] = std::max(high[a], points[rows[k]][a]);
    }
  }
  std::array<float, 3> center{};
  float squares = 0.F;
  for (std::size_t a = 0; a < 3; ++a) {
    center[a] = 0.5F * (low[a] + high[a]);
    squares += (high[a] - center[a]) * (high[a] - center[a]);
  }
  out.clear();
  field.listDipoles(center.data(), std::sqrt(squares), out);
}

// \return whether the normal of p is another one now
bool tilt(const DipoleList& dipoles, const float* x, float radius, float* normal) {
  std::array<float, 3> n{};
  steepestDescent(dipoles, x, radius, n.data());
  // In double: far from all others the field is so weak that squares leave float's range.
  const auto square = [](float v) { return static_cast<double>(v) * static_cast<double>(v); };
  const double length = std::sqrt(square(n[0]) + square(n[1]) + square(n[2]));
  if (!std::isfinite(length) || !(length > 0.0)) return false;
  // Which of two near sheets a point is on is the segments' to say.
  if (!(n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2] > 0.F)) return false;
  for (std::size_t a = 0; a < 3; ++a)
    normal[a] = static_cast<float>(static_cast<double>(n[a]) / length);
  return true;
}

}  // namespace

std::size_t refineByWinding(const PointView& points, const std::vector<float>& spacing,
                            float residual, int threads, FilteredNormals& filtered) {
  const std::size_t n = points.size;
  if (spacing.size() != n || filtered.confidences.size() != n || filtered.normals.size() != 4 * n) {
    return 0;
  }
  if (!(residual >= kNoisy)) return 0;
  const std::vector<std::uint32_t> rows = listDoubtful(spacing, filtered);
  if (rows.empty()) return 0;
  const std::vector<Run> runs = cutRuns(points, spacing, rows);
  const std::vector<float> dipoles = dipolesOf(spacing, filtered);
  WindingNumber field;
  field.build(points, dipoles, {});
  std::size_t changed = 0;
#pragma omp parallel num_threads(resolveThreads(threads, runs.size(), 50000.0)) reduction(+ : changed)
  {
    DipoleList seen;
#pragma omp for schedule(dynamic, 16)
    for (std::size_t r = 0; r < runs.size(); ++r) {
      listDipolesOf(field, points, rows, runs[r], seen);
      for (std::size_t k = runs[r].first; k < runs[r].last; ++k) {
        const std::size_t p = rows[k];
        const float radius = (1.F + residual) * spacing[p];
        if (tilt(seen, points[p], radius, filtered.normals.data() + 4 * p)) ++changed;
      }
    }
  }
  return changed;
}

}  // namespace segorient
