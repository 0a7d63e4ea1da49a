// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <vector>

#include "features/local_normals.h"

namespace segorient::detail {

/// What a kernel works on; see estimateNormals().
struct LocalFitJob {
  PointView queries;
  const float* xyz = nullptr;  ///< the neighbours' coordinates, 4 floats a point
  bool same_points = false;    ///< the neighbours are of the queries' own cloud
  const Neighborhoods* neighborhoods = nullptr;
  const pcl::index_t* rows = nullptr;  ///< rows to do, or null for all
  NormalEstimator estimator = NormalEstimator::PLANE;
  NormalEstimator first_guess = NormalEstimator::PLANE;
  int entries = 0;  ///< most entries of a row to use, the point itself included
  float* normals = nullptr;
  LocalCurvature* curvatures = nullptr;
  /// Standard deviation of the neighbours from the surface, one a row, or null; AwAS only.
  float* residuals = nullptr;

  std::size_t row(std::size_t i) const { return rows ? static_cast<std::size_t>(rows[i]) : i; }
  int count(std::size_t r) const {
    const int c = neighborhoods->count(r);
    return c < entries ? c : entries;
  }
};

/// The kernels read 4 floats a point: rows laid out otherwise are copied.
class SEGORIENT_FEATURES_EXPORT FourFloats {
 public:
  /// \param points must outlive this
  explicit FourFloats(const PointView& points);
  const float* data() const { return data_; }

 private:
  std::vector<float> copy_;
  const float* data_;
};

/// Positions of some points, 4 floats each.
std::vector<float> positionsOf(const PointView& points, const std::vector<pcl::index_t>& which);

/// Of the rows of a table.
/// \param queries one a row \param xyz of what the table speaks of \param k neighbours to use
SEGORIENT_FEATURES_EXPORT LocalFitJob jobOf(const PointView& queries, const FourFloats& xyz,
                                            const Neighborhoods& table, int k);

/// estimateNormals() with what only this library needs.
void estimateNormals(const PointView& queries, const PointView& points,
                     const Neighborhoods& neighborhoods, const LocalNormalOptions& options,
                     float* normals, LocalCurvature* curvatures, float* residuals,
                     const std::vector<pcl::index_t>* rows);

/// Plane of one row in double precision, for neighbourhoods that are too slim for float.
/// \return false, and NaN in `normal` (nx, ny, nz, curvature), where there is no plane
bool fitPlaneExactly(const LocalFitJob& job, std::size_t row, float* normal);

}  // namespace segorient::detail
