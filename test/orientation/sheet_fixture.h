// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/search/median_hash_index.h>

#include <array>
#include <cmath>
#include <vector>

#include "features/sheet_normals.h"
#include "labelled_solids.h"
#include "oriented_shapes.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::test {

inline PointView viewOf(const std::vector<float>& packed) {
  return {packed.data(), 4, packed.size() / 4};
}

inline Neighborhoods neighborsOf(const std::vector<float>& xyz, int k = kSheetNeighbors) {
  search::MedianHashIndex index;
  index.build(viewOf(xyz), nullptr, {});
  Neighborhoods table;
  index.nearestKAll(k + 1, table, false);
  return table;
}

/// Points and their true normals, 4 floats each.
struct TrueNormals {
  std::vector<float> xyz;
  std::vector<float> normals;

  void add(const std::array<double, 3>& p, const std::array<double, 3>& n) {
    for (const double v : p) xyz.push_back(static_cast<float>(v));
    for (const double v : n) normals.push_back(static_cast<float>(v));
    xyz.push_back(0.F);
    normals.push_back(0.F);
  }
  std::size_t size() const { return xyz.size() / 4; }
};

/// Share of the points whose normal is within `degrees` of the true one, whatever its sign.
inline double shareWithin(const std::vector<float>& normals, const std::vector<float>& truth,
                          double degrees) {
  std::size_t good = 0;
  const std::size_t n = truth.size() / 4;
  for (std::size_t i = 0; i < n; ++i) {
    good +=
        std::fabs(dot3(&normals[4 * i], &truth[4 * i])) > std::cos(degrees * M_PI / 180) ? 1U : 0U;
  }
  return static_cast<double>(good) / static_cast<double>(n);
}

/// Share of the points whose normal points the true way; a NaN normal does not.
inline double shareOutward(const std::vector<float>& normals, const std::vector<float>& truth) {
  std::size_t good = 0;
  const std::size_t n = truth.size() / 4;
  for (std::size_t i = 0; i < n; ++i) good += dot3(&normals[4 * i], &truth[4 * i]) > 0.F ? 1U : 0U;
  return static_cast<double>(good) / static_cast<double>(n);
}

}  // namespace segorient::test
