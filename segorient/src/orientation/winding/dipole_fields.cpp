// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/dipole_fields.h"

#include <array>
#include <cstddef>

#include "common/box.h"
#include "common/threads.h"
#include "orientation/winding/winding_number.h"

namespace segorient {
namespace {

// Places that share a list; of the order of points, which jumps here and there.
struct Run {
  std::size_t first;
  std::size_t last;
  std::array<float, 3> center;
  float reach;
};

std::vector<Run> cutRuns(const PointView& at, float widest) {
  constexpr std::size_t kPlaces = 32;  // listing costs a tenth of the sums then
  std::vector<Run> runs;
  for (std::size_t first = 0; first < at.size;) {
    Box box;
    box.add(at[first]);
    std::size_t last = first + 1;
    for (; last < at.size && last - first < kPlaces; ++last) {
      Box wider = box;
      wider.add(at[last]);
      if (0.5F * wider.diagonal() > widest) break;
      box = wider;
    }
    runs.push_back({first, last, box.center(), 0.5F * box.diagonal()});
    first = last;
  }
  return runs;
}

template <typename Evaluate>
void forEachPlace(const PointView& at, const DipoleCloud& from, float radius, int threads,
                  Evaluate&& evaluate) {
  constexpr float kWidest = 4.F;  // in radii: what is nearer is seen point by point
  const std::vector<Run> runs = cutRuns(at, kWidest * radius);
  WindingNumber tree;
  const std::vector<std::uint32_t> all;
  tree.build(from.points, from.dipoles, from.rows != nullptr ? *from.rows : all);
#pragma omp parallel num_threads(resolveThreads(threads, runs.size(), 30000.0))
  {
    DipoleList seen;
#pragma omp for schedule(dynamic, 16)
    for (std::size_t r = 0; r < runs.size(); ++r) {
      seen.clear();
      tree.listDipoles(runs[r].center.data(), runs[r].reach + radius, seen);
      for (std::size_t i = runs[r].first; i < runs[r].last; ++i) evaluate(seen, i);
    }
  }
}

}  // namespace

std::vector<float> windingNumbers(const PointView& at, const DipoleCloud& from, float radius,
                                  int threads) {
  std::vector<float> out(at.size, 0.F);
  forEachPlace(at, from, radius, threads, [&](const DipoleList& seen, std::size_t i) {
    out[i] = windingNumberOf(seen, at[i], radius);
  });
  return out;
}

std::vector<float> steepestDescents(const PointView& at, const DipoleCloud& from, float radius,
                                    int threads) {
  std::vector<float> out(4 * at.size, 0.F);
  forEachPlace(at, from, radius, threads, [&](const DipoleList& seen, std::size_t i) {
    steepestDescent(seen, at[i], radius, &out[4 * i]);
  });
  return out;
}

std::vector<float> windingPulls(const PointView& at, const DipoleCloud& from, float radius,
                                int threads) {
  std::vector<float> out(4 * at.size, 0.F);
  forEachPlace(at, from, radius, threads, [&](const DipoleList& seen, std::size_t i) {
    windingPull(seen, at[i], radius, &out[4 * i]);
  });
  return out;
}

}  // namespace segorient
