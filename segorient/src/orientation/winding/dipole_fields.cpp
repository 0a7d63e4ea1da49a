// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/dipole_fields.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "common/box.h"
#include "common/parallel_for.h"
#include "orientation/winding/winding_number.h"

namespace segorient {
namespace {

// Places that share a list; of the order of points, which jumps here and there.
struct Run {
  std::size_t first;
  std::size_t last;
  std::array<float, 3> center;
  float reach;   ///< of the places from the centre
  float radius;  ///< the largest
};

std::vector<Run> cutRuns(const PointView& at, const std::vector<float>& radii) {
  constexpr float kWidest = 6.F;       // in radii; 4 and 9 take a tenth longer
  constexpr std::size_t kPlaces = 32;  // more share a list then, but each has more to sum
  std::vector<Run> runs;
  for (std::size_t first = 0; first < at.size;) {
    Box box;
    box.add(at[first]);
    const float widest = kWidest * radii[first];
    float largest = radii[first];
    std::size_t last = first + 1;
    for (; last < at.size && last - first < kPlaces; ++last) {
      Box wider = box;
      wider.add(at[last]);
      if (0.5F * wider.diagonal() > widest) break;
      box = wider;
      largest = std::max(largest, radii[last]);
    }
    runs.push_back({first, last, box.center(), 0.5F * box.diagonal(), largest});
    first = last;
  }
  return runs;
}

// \param rows empty = all
DipoleList listOf(const DipoleCloud& from, const std::vector<std::uint32_t>& rows) {
  DipoleList out;
  const std::size_t count = rows.empty() ? from.points.size : rows.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = rows.empty() ? i : rows[i];
    out.add(from.points[row], &from.dipoles[4 * row]);
  }
  return out;
}

template <typename Evaluate>
void forEachPlace(const PointView& at, const DipoleCloud& from, const std::vector<float>& radii,
                  int threads, Evaluate&& evaluate) {
  const std::vector<Run> runs = cutRuns(at, radii);
  WindingNumber tree;
  const std::vector<std::uint32_t> all;
  const std::vector<std::uint32_t>& rows = from.rows != nullptr ? *from.rows : all;
  tree.build(from.points, from.dipoles.data(), rows, threads);
  const DipoleList points = listOf(from, rows);
  parallelFor(
      runs.size(), threads, 30000.0, [] { return DipoleList(); },
      [&](std::size_t r, DipoleList& seen) {
        seen.clear();
        tree.listDipoles(runs[r].center.data(), runs[r].reach + runs[r].radius, points, seen);
        for (std::size_t i = runs[r].first; i < runs[r].last; ++i) evaluate(seen, i);
      });
}

std::vector<float> everywhere(const PointView& at, float radius) {
  return std::vector<float>(at.size, radius);
}

}  // namespace

std::vector<float> dipolesOf(const std::vector<float>& normals, const std::vector<float>& areas) {
  std::vector<float> out(4 * areas.size(), 0.F);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (!isFinite(&normals[4 * i])) continue;
    for (std::size_t a = 0; a < 3; ++a) out[4 * i + a] = areas[i] * normals[4 * i + a];
    out[4 * i + 3] = areas[i];
  }
  return out;
}

std::vector<float> windingNumbers(const PointView& at, const DipoleCloud& from, float radius,
                                  int threads) {
  std::vector<float> out(at.size, 0.F);
  forEachPlace(at, from, everywhere(at, radius), threads,
               [&](const DipoleList& seen, std::size_t i) {
                 out[i] = windingNumberOf(seen, at[i], radius);
               });
  return out;
}

std::vector<float> steepestDescents(const PointView& at, const DipoleCloud& from, float radius,
                                    int threads) {
  return steepestDescents(at, from, everywhere(at, radius), threads);
}

std::vector<float> steepestDescents(const PointView& at, const DipoleCloud& from,
                                    const std::vector<float>& radii, int threads) {
  std::vector<float> out(4 * at.size, 0.F);
  forEachPlace(at, from, radii, threads, [&](const DipoleList& seen, std::size_t i) {
    steepestDescent(seen, at[i], radii[i], &out[4 * i]);
  });
  return out;
}

std::vector<float> windingPulls(const PointView& at, const DipoleCloud& from, float radius,
                                int threads) {
  std::vector<float> out(4 * at.size, 0.F);
  forEachPlace(at, from, everywhere(at, radius), threads,
               [&](const DipoleList& seen, std::size_t i) {
                 windingPull(seen, at[i], radius, &out[4 * i]);
               });
  return out;
}

}  // namespace segorient
