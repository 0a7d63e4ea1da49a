// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "features/local_normals.h"

namespace segorient::detail {

/// Where surfaces are fitted, and to what.
struct Surroundings {
  PointView at;                ///< a point for each row of the table
  PointView points;            ///< the cloud that the table speaks of
  const Neighborhoods& table;  ///< each row with the point itself first
};

/// Surfaces of one size at some rows; see estimateNormals().
struct Surfaces {
  NormalEstimator estimator;
  // Of a cloud's many rows perhaps a few: the others' memory is never touched.
  std::unique_ptr<float[]> normals;    ///< 4 a row
  std::unique_ptr<float[]> residuals;  ///< standard deviations of the neighbours

  explicit Surfaces(NormalEstimator e = NormalEstimator::AWAS_QUADRATIC) : estimator(e) {}
  void fit(const Surroundings& of, int k, int threads, const std::vector<pcl::index_t>& rows);
  /// The same with the normals where the caller wants them.
  void fitInto(float* all, const Surroundings& of, int k, int threads,
               const std::vector<pcl::index_t>& rows);
  /// Gives a row its normal.
  void copyNormal(std::size_t row, float* all) const;
};

/// What surfaces at some rows leave of their neighbourhoods: a standard deviation for each of
/// `rows`. Takes memory for these only.
std::vector<float> sampleResiduals(NormalEstimator estimator, const PointView& points,
                                   const Neighborhoods& table, int k, int threads,
                                   const std::vector<pcl::index_t>& rows);

/// Noise of a cloud.
struct CloudNoise {
  double length = 0.0;       ///< standard deviation
  double in_spacings = 0.0;  ///< the same over the mean distance to the six nearest
};

/// Some thousand rows spread evenly over a table, or over some of its rows.
std::vector<pcl::index_t> sampleRows(std::size_t size);
std::vector<pcl::index_t> sampleRows(const std::vector<pcl::index_t>& of);

/// From the residuals of quadratic surfaces, medians over a sample: edges and creases, where
/// surfaces do not fit, are the minority. 0 for fewer than 16 points.
SEGORIENT_FEATURES_EXPORT CloudNoise sampleNoise(const PointView& points,
                                                 const Neighborhoods& neighborhoods, int threads);

/// Least noise, in spacings: less cannot be told from what a quadratic leaves of a smooth surface,
/// h^3 / (6 R^2) a spacing h away where the radius R of its curvature changes within R. Of R = 4 h,
/// a quarter circle by six points, that is a hundredth.
constexpr double kLeastNoise = 0.01;

/// What is fitted to a neighbourhood, by the number of its coefficients.
enum class Fitted { PLANES = 3, QUADRATICS = 6, CUBICS = 10 };

/// Whether noise explains what a surface leaves of a neighbourhood: its standard deviation, with
/// the scatter of such estimates.
class Explained {
 public:
  /// \param k neighbours that it was fitted to
  Explained(const Surroundings& of, double noise, int k, Fitted fitted);

  bool operator()(std::size_t row, double residual) const;

 private:
  const Surroundings& of_;
  double noise_;
  double scatter_;
};

/// Standard deviation of the nearest neighbours, the point itself among them, from their plane;
/// infinite where they have none.
double planeResidual(const Surroundings& of, std::size_t row, int k, const float* normal);

}  // namespace segorient::detail
