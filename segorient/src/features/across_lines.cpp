// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/across_lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "features/local_fit_job.h"
#include "features/more_neighbors.h"
#include "features/slope_gain.h"

namespace segorient::detail {
namespace {

// What is tried for noisy clouds, too, up to what the table of all stages has.
constexpr std::array<int, 3> kSizes{16, 24, 32};

// \return which of `open` no surface is taken for
std::vector<pcl::index_t> fitAcross(const Surroundings& of, double noise, int threads,
                                    std::vector<pcl::index_t> open, Surfaces& surfaces) {
  for (const int k : kSizes) {
    if (k >= of.table.k()) break;
    surfaces.fit(of, k, threads, open);
    const Explained explained(of, noise, k, Fitted::QUADRATICS);
    const auto isTaken = [&](pcl::index_t r) {
      const auto row = static_cast<std::size_t>(r);
      return explained(row, static_cast<double>(surfaces.residuals[row])) &&
             tellsSlope(of, row, k, &surfaces.normals[4 * row]);
    };
    open.erase(std::remove_if(open.begin(), open.end(), isTaken), open.end());
  }
  return open;
}

}  // namespace

std::vector<pcl::index_t> takeAcrossLines(const Surroundings& of,
                                          const search::MedianHashIndex* index,
                                          const std::vector<pcl::index_t>& rows, double noise,
                                          int threads, float* normals) {
  // Rows of the table, or the same of one that has enough neighbours.
  std::vector<pcl::index_t> asked = rows;
  std::vector<float> at;
  Neighborhoods wider;
  const bool widens = index != nullptr && of.table.k() <= kSizes.back();
  if (widens) {
    std::iota(asked.begin(), asked.end(), 0);
    at = positionsOf(of.at, rows);
    wider = nearestOfPlaces(*index, {at.data(), 4, rows.size()}, kSizes.back() + 1, threads);
  }
  const Surroundings wide{{at.data(), 4, rows.size()}, of.points, wider};
  Surfaces surfaces;
  const std::vector<pcl::index_t> open =
      fitAcross(widens ? wide : of, noise, threads, asked, surfaces);
  std::vector<pcl::index_t> left;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (left.size() < open.size() && open[left.size()] == asked[r]) {
      left.push_back(rows[r]);
      continue;
    }
    std::copy_n(&surfaces.normals[4 * static_cast<std::size_t>(asked[r])], 4,
                normals + 4 * static_cast<std::size_t>(rows[r]));
  }
  return left;
}

}  // namespace segorient::detail
