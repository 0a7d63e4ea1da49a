// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/dipole_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

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

class Box {
 public:
  void add(const float* p) {
    for (std::size_t a = 0; a < 3; ++a) {
      low_[a] = std::min(low_[a], p[a]);
      high_[a] = std::max(high_[a], p[a]);
    }
  }
  float halfDiagonal() const {
    float squares = 0.F;
    for (std::size_t a = 0; a < 3; ++a) squares += (high_[a] - low_[a]) * (high_[a] - low_[a]);
    return 0.5F * std::sqrt(squares);
  }
  std::array<float, 3> center() const {
    std::array<float, 3> out{};
    for (std::size_t a = 0; a < 3; ++a) out[a] = 0.5F * (low_[a] + high_[a]);
    return out;
  }

 private:
  static constexpr float kHuge = std::numeric_limits<float>::max();  // of an empty box
  std::array<float, 3> low_{kHuge, kHuge, kHuge};
  std::array<float, 3> high_{-kHuge, -kHuge, -kHuge};
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
      if (wider.halfDiagonal() > widest) break;
      box = wider;
    }
    runs.push_back({first, last, box.center(), box.halfDiagonal()});
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
