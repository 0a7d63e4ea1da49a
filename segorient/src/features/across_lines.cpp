// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/across_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "common/parallel_for.h"
#include "features/local_fit_job.h"
#include "features/slope_gain.h"

namespace segorient::detail {
namespace {

// What is tried for noisy clouds, too, up to what the table of all stages has.
constexpr std::array<int, 3> kSizes{16, 24, 32};
constexpr int kQuadratic = 6;  // Coefficients.
// ns a point, see resolveThreads().
constexpr double kQueryTime = 2000.0;

Neighborhoods widerTable(const Surroundings& of, const search::MedianHashIndex* index,
                         const std::vector<pcl::index_t>& rows, int threads) {
  const int entries =
      index != nullptr ? kSizes.back() + 1 : std::min(of.table.k(), kSizes.back() + 1);
  Neighborhoods wider;
  wider.reset(rows.size(), entries, false);
  parallelFor(rows.size(), threads, kQueryTime, [&](std::size_t r) {
    const auto row = static_cast<std::size_t>(rows[r]);
    pcl::index_t* out = wider.mutableIndices(r);
    int count = std::min(of.table.count(row), entries);
    if (of.table.k() < entries) {
      std::array<float, kSizes.back() + 1> squares;
      count = index->nearestK(of.at[row], entries, out, squares.data(), 0.F);
    } else {
      std::copy_n(of.table.indices(row), count, out);
    }
    wider.setCount(r, count);
  });
  return wider;
}

}  // namespace

std::vector<pcl::index_t> takeAcrossLines(const Surroundings& of,
                                          const search::MedianHashIndex* index,
                                          const std::vector<pcl::index_t>& rows, double noise,
                                          int threads, float* normals) {
  const Neighborhoods table = widerTable(of, index, rows, threads);
  const std::vector<float> at = positionsOf(of.at, rows);
  const Surroundings wider{{at.data(), 4, rows.size()}, of.points, table};
  std::vector<pcl::index_t> open(rows.size());
  std::iota(open.begin(), open.end(), 0);
  Surfaces surfaces;
  for (const int k : kSizes) {
    if (k >= table.k()) break;
    surfaces.fit(wider, k, threads, open);
    const Explained explained(wider, noise, k + 1 - kQuadratic);
    open.erase(std::remove_if(open.begin(), open.end(),
                              [&](pcl::index_t r) {
                                const auto row = static_cast<std::size_t>(r);
                                return explained(row,
                                                 static_cast<double>(surfaces.residuals[row])) &&
                                       tellsSlope(wider, row, k, &surfaces.normals[4 * row]);
                              }),
               open.end());
  }
  std::vector<pcl::index_t> taken;
  for (std::size_t r = 0, o = 0; r < rows.size(); ++r) {
    if (o < open.size() && static_cast<std::size_t>(open[o]) == r) {
      ++o;
      continue;
    }
    std::copy_n(&surfaces.normals[4 * r], 4, normals + 4 * static_cast<std::size_t>(rows[r]));
    taken.push_back(rows[r]);
  }
  return taken;
}

}  // namespace segorient::detail
