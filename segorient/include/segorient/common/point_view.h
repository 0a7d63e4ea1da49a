// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cmath>
#include <cstddef>

namespace segorient {

/// Read-only view of points (or normals) in memory that belongs to somebody else: row i is three
/// consecutive floats at `data + i * stride`.
///
/// This is what every stage computes on. A PCL cloud whose point type has x, y, z in a row is
/// viewed without a copy (see CloudPoints in common/impl/cloud_access.hpp).
struct PointView {
  const float* data = nullptr;  ///< first row
  std::size_t stride = 4;       ///< floats from one row to the next
  std::size_t size = 0;         ///< number of rows

  const float* operator[](std::size_t i) const { return data + i * stride; }
};

/// Read-only view of normals with their curvatures: curvature i is the float at
/// `data + i * stride + curvature`.
struct NormalView : PointView {
  std::size_t curvature = 3;  ///< floats from the start of a normal to its curvature

  NormalView() = default;
  /// Rows that start with normal and curvature.
  /// \param floats from one row to the next, at least 4
  NormalView(const float* first, std::size_t floats, std::size_t rows)
      : PointView{first, floats, rows} {}
  /// \param curvature_offset floats from normal_x to the curvature: in PCL's types 4 or more, see
  ///        CloudNormals in common/impl/cloud_access.hpp
  NormalView(const PointView& normals, std::size_t curvature_offset)
      : PointView(normals), curvature(curvature_offset) {}
};

/// Whether all three coordinates of a row are finite.
inline bool isFinite(const float* p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

}  // namespace segorient
