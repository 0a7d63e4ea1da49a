// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstddef>
#include <vector>

namespace segorient {

/// How a normal is found from a neighbourhood (paper, section 2.2).
enum class NormalEstimator {
  Plane,          ///< least-squares plane of the neighbours and the point
  LCT,            ///< local centre triangulation: area-weighted fan around the centre of mass
  LDT,            ///< local Delaunay triangulation: unit-weighted star of the point
  AwASQuadratic,  ///< approximation with an analytic surface: z = f(x, y) with 6 coefficients
  AwASCubic,      ///< the same with 10; where they are not determined, the quadratic one
  /// Chosen point by point from the cloud itself: see estimateNormalsAutomatically(). Functions
  /// that do not say otherwise take it for Plane.
  Automatic
};

/// Curvatures of the fitted surface at the point, by pcl::PrincipalCurvatures' conventions:
/// direction of the larger one, then both, |pc1| >= |pc2|. Signs are those of the surface seen
/// along the normal: positive where it bends towards the normal. NaN where no surface was fitted.
struct LocalCurvature {
  float direction[3];
  float pc1;
  float pc2;
};

/// What to estimate, and from how many neighbours.
struct LocalNormalOptions {
  NormalEstimator estimator = NormalEstimator::Plane;
  /// Where AwAS starts from: Plane, LCT or LDT; others mean Plane.
  NormalEstimator first_guess = NormalEstimator::Plane;
  /// Neighbours of each row to use beside its first entry (the point itself); <= 0 = all.
  int k = 0;
  int threads = 0;  ///< see resolveThreads()
  bool portable =
      false;  ///< do without wide vector instructions; the result is the same to the bit
};

/// Estimates one unoriented normal a row of `neighborhoods`.
///
/// Computes with offsets from the point, so a cloud far from the origin loses nothing but what its
/// own rounding has lost already. The curvature is lambda0 / (lambda0 + lambda1 + lambda2) of the
/// plane fit for every estimator, as in PCL. Duplicates of the point count for the plane and are
/// ignored elsewhere. NaN, curvature included, where the neighbourhood has no plane: fewer than
/// three points, all in one place or in a line as far as their rounding tells. LCT and LDT use the
/// neighbours' plane as projection plane, AwAS that of its first guess.
///
/// \param queries row i is the point that row i of the table belongs to
/// \param points what the table's indices refer to; often the same as `queries`
/// \param normals 4 floats a row: nx, ny, nz, curvature
/// \param curvatures one a row or null; needs AwAS, other estimators give NaN
/// \param rows rows to do, or null for all; others are left as they are
void estimateNormals(const PointView& queries, const PointView& points,
                     const Neighborhoods& neighborhoods, const LocalNormalOptions& options,
                     float* normals, LocalCurvature* curvatures = nullptr,
                     const std::vector<pcl::index_t>* rows = nullptr);

/// The same for points that are their own queries.
inline void estimateNormals(const PointView& points, const Neighborhoods& neighborhoods,
                            const LocalNormalOptions& options, float* normals) {
  estimateNormals(points, points, neighborhoods, options, normals);
}

}  // namespace segorient
