// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <Eigen/Core>

#include <array>
#include <cstddef>

#include "features/sheet_normals.h"

namespace segorient::detail {

/// Sums over a set of offsets from the query point: enough for its best-fit plane.
struct Moments {
  float n = 0.F;
  float x = 0.F, y = 0.F, z = 0.F;
  float xx = 0.F, xy = 0.F, xz = 0.F, yy = 0.F, yz = 0.F, zz = 0.F;

  /// The query point itself, offset 0.
  void addOrigin() { n += 1.F; }
  void add(float dx, float dy, float dz) {
    n += 1.F;
    x += dx;
    y += dy;
    z += dz;
    xx += dx * dx;
    xy += dx * dy;
    xz += dx * dz;
    yy += dy * dy;
    yz += dy * dz;
    zz += dz * dz;
  }
};

struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f lambda = Eigen::Vector3f::Zero();  ///< variances, ascending
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();    ///< of the offsets
  bool valid = false;                                ///< false for fewer than 3 points or a line

  /// Smallest variance in the sum of all three, as PCL's curvature.
  float variation() const {
    const float sum = lambda.sum();
    return sum > 0.F ? lambda[0] / sum : 0.F;
  }
};
/// Whether variances are those of more than a line: below that, the width is rounding.
inline bool spansTwo(const Eigen::Vector3f& lambda) {
  return lambda[1] > 1e-6F * lambda[2];
}
SEGORIENT_FEATURES_EXPORT Plane fitPlane(const Moments& moments);

/// The neighbours of one point: offsets from it in units of its spacing, as separate arrays; unused
/// entries are 0 with weight 0.
struct Offsets {
  alignas(32) std::array<float, kSheetNeighbors> x;
  alignas(32) std::array<float, kSheetNeighbors> y;
  alignas(32) std::array<float, kSheetNeighbors> z;
  /// 1 for the nearest down to 1/2 for the farthest.
  alignas(32) std::array<float, kSheetNeighbors> weight;
  int n = 0;

  float along(std::size_t j, const Eigen::Vector3f& direction) const {
    return x[j] * direction.x() + y[j] * direction.y() + z[j] * direction.z();
  }
};

/// Of the point and its k nearest.
Moments momentsOf(const Offsets& offsets, int k);

Offsets gatherOffsets(const PointView& points, const Neighborhoods& neighborhoods, std::size_t i,
                      float spacing);

/// Neighbours whose mean distance is the spacing.
constexpr int kFirstRing = 6;

/// Mean distance from a place to some points; 0 without any.
SEGORIENT_FEATURES_EXPORT double meanDistance(const float* from, const PointView& points,
                                              const pcl::index_t* others, int n);

/// The same from a point.
inline float meanDistance(const PointView& points, std::size_t i, const pcl::index_t* others,
                          int n) {
  return static_cast<float>(meanDistance(points[i], points, others, n));
}

/// The same to its k nearest.
SEGORIENT_FEATURES_EXPORT float meanDistance(const PointView& points,
                                             const Neighborhoods& neighborhoods, std::size_t i,
                                             int k);

/// The plane through the point that most of its neighbours lie on, within `tolerance` spacings;
/// invalid where none is clearly a plane.
Plane fitDominant(const Offsets& offsets, const Plane& start, float tolerance);

}  // namespace segorient::detail
