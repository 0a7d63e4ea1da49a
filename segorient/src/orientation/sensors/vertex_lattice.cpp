// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/vertex_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/at.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"

namespace segorient::detail {
namespace {

constexpr std::size_t kSamples = 600;
// Neighbours that are asked for their nearest; not the nearest itself, which often has the same.
constexpr int kFirst = 2;
constexpr int kLast = 5;
// Of the logarithm of that distance: what noise of a tenth of it makes. At random it is .5; of 27
// clouds of vertices .05 at most, of scans that two to four stations made .12 and more, but where
// each of two saw its own half.
constexpr float kSame = 0.1F;

constexpr double kSampleTime = 3000.0;  // ns, see resolveThreads()

using Row = std::array<pcl::index_t, kLast + 1>;
using Squares = std::array<float, kLast + 1>;

// The point itself is the first; 0 where points repeat, or there is none.
float squareToNearest(const PointView& points, const search::MedianHashIndex& index,
                      std::size_t i) {
  std::array<pcl::index_t, 2> row{};
  std::array<float, 2> squares{};
  return index.nearestK(points[i], 2, row.data(), squares.data()) == 2 ? squares[1] : 0.F;
}

// Median over a point's neighbours of how far the distances differ, as a logarithm.
float difference(const PointView& points, const search::MedianHashIndex& index, std::size_t i) {
  Row row{};
  Squares squares{};
  const int found = index.nearestK(points[i], kLast + 1, row.data(), squares.data());
  std::vector<float> logs;
  for (int j = kFirst; j < found; ++j) {
    const float square = squareToNearest(points, index, at(row[at(j)]));
    if (square > 0.F && squares[1] > 0.F) {
      logs.push_back(0.5F * std::fabs(std::log(square / squares[1])));
    }
  }
  return logs.empty() ? 0.F : median(logs);
}

}  // namespace

bool formALattice(const PointView& points, const search::MedianHashIndex& index, int threads) {
  const EveryNth some(points.size, kSamples);
  if (some.size() == 0) return false;
  std::vector<float> differences(some.size());
  parallelFor(some.size(), threads, kSampleTime,
              [&](std::size_t s) { differences[s] = difference(points, index, some[s]); });
  return median(differences) < kSame;
}

}  // namespace segorient::detail
