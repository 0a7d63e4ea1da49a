// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/search/median_hash_index.h>

#include <array>
#include <vector>

#include "io/cloud_table.h"

namespace segorient::program {

/// A surface that is known to be the true one, as points with normals close to each other.
class TrueSurface {
 public:
  /// The points of a cloud with normals; of a mesh, a grid of points on each triangle.
  /// \param origin what to move it by; \param threads for the search
  TrueSurface(const CloudTable& table, const std::array<double, 3>& origin, int threads);

  bool empty() const { return index_.size() == 0; }
  /// Distance of a point from the plane of the nearest true point.
  double distance(const float* point) const;

 private:
  void addPoints(const CloudTable& table, const std::array<double, 3>& origin);
  void addTriangles(const CloudTable& table, const std::array<double, 3>& origin);
  void add(const std::array<double, 3>& position, const std::array<double, 3>& normal);

  std::vector<float> positions_;  // 3 floats a point
  std::vector<float> normals_;    // unit length
  search::MedianHashIndex index_;
};

}  // namespace segorient::program
