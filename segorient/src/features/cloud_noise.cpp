// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/cloud_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/every_nth.h"
#include "common/median.h"
#include "features/local_fit_job.h"
#include "features/local_normals.h"
#include "features/sheet_fit.h"

namespace segorient::detail {
namespace {

// The noise is what is left of quadratic surfaces through the fewest neighbours that leave
// anything: larger ones take what the surface bends beyond a quadratic for noise.
constexpr int kNoiseNeighbors = 8;
// Median of a standard deviation estimated with as much freedom as they have (3).
constexpr double kMedianShare = 0.888;
// A median of fewer is by chance; of so many it is known to some percent.
constexpr std::size_t kFewestPoints = 16;
constexpr std::size_t kSamples = 4000;
// A residual is taken for noise up to this many of its own standard deviations.
constexpr double kTolerance = 2.5;

double spacingAt(const Surroundings& of, std::size_t row) {
  return meanDistance(of.at[row], of.points, of.table.indices(row) + 1,
                      std::min(of.table.count(row) - 1, kFirstRing));
}

}  // namespace

void Surfaces::fit(const Surroundings& of, int k, int threads,
                   const std::vector<pcl::index_t>& rows) {
  if (normals == nullptr) normals.reset(new float[4 * of.at.size]);
  fitInto(normals.get(), of, k, threads, rows);
}

void Surfaces::fitInto(float* all, const Surroundings& of, int k, int threads,
                       const std::vector<pcl::index_t>& rows) {
  LocalNormalOptions options;
  options.estimator = estimator;
  options.k = k;
  options.threads = threads;
  if (residuals == nullptr) residuals.reset(new float[of.at.size]);
  estimateNormals(of.at, of.points, of.table, options, all, nullptr, residuals.get(), &rows);
}

void Surfaces::copyNormal(std::size_t row, float* all) const {
  std::copy_n(&normals[4 * row], 4, all + 4 * row);
}

std::vector<float> sampleResiduals(NormalEstimator estimator, const PointView& points,
                                   const Neighborhoods& table, int k, int threads,
                                   const std::vector<pcl::index_t>& rows) {
  const int entries = std::min(table.k(), k + 1);
  Neighborhoods sample;
  sample.reset(rows.size(), entries, false);
  std::vector<float> queries(3 * rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto row = static_cast<std::size_t>(rows[r]);
    const int count = std::min(table.count(row), entries);
    std::copy_n(table.indices(row), count, sample.mutableIndices(r));
    sample.setCount(r, count);
    std::copy_n(points[row], 3, &queries[3 * r]);
  }
  LocalNormalOptions options;
  options.estimator = estimator;
  options.k = k;
  options.threads = threads;
  std::vector<float> normals(4 * rows.size());
  std::vector<float> residuals(rows.size());
  estimateNormals({queries.data(), 3, rows.size()}, points, sample, options, normals.data(),
                  nullptr, residuals.data(), nullptr);
  return residuals;
}

std::vector<pcl::index_t> sampleRows(std::size_t size) {
  std::vector<pcl::index_t> rows;
  for (const std::size_t i : detail::EveryNth(size, kSamples)) {
    rows.push_back(static_cast<pcl::index_t>(i));
  }
  return rows;
}

std::vector<pcl::index_t> sampleRows(const std::vector<pcl::index_t>& of) {
  std::vector<pcl::index_t> rows = sampleRows(of.size());
  for (pcl::index_t& row : rows) row = of[static_cast<std::size_t>(row)];
  return rows;
}

CloudNoise sampleNoise(const PointView& points, const Neighborhoods& neighborhoods, int threads) {
  if (points.size < kFewestPoints || neighborhoods.size() != points.size) return {};
  const std::vector<pcl::index_t> rows = sampleRows(points.size);
  const std::vector<float> residuals = sampleResiduals(
      NormalEstimator::AWAS_QUADRATIC, points, neighborhoods, kNoiseNeighbors, threads, rows);
  const Surroundings all{points, points, neighborhoods};
  std::vector<float> lengths;
  std::vector<float> ratios;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto row = static_cast<std::size_t>(rows[r]);
    const float length = residuals[r];
    const auto ratio = static_cast<float>(static_cast<double>(length) / spacingAt(all, row));
    if (!std::isfinite(ratio)) continue;
    lengths.push_back(length);
    ratios.push_back(ratio);
  }
  return {static_cast<double>(median(std::move(lengths))) / kMedianShare,
          static_cast<double>(median(std::move(ratios))) / kMedianShare};
}

Explained::Explained(const Surroundings& of, double noise, int k, Fitted fitted)
    : of_(of),
      noise_(noise),
      // Freedom: points less coefficients.
      scatter_(1.0 + kTolerance / std::sqrt(2.0 * (k + 1 - static_cast<int>(fitted)))) {}

bool Explained::operator()(std::size_t row, double residual) const {
  if (residual <= scatter_ * noise_) return true;
  return residual <= scatter_ * kLeastNoise * spacingAt(of_, row);
}

double planeResidual(const Surroundings& of, std::size_t row, int k, const float* normal) {
  const int count = std::min(of.table.count(row), k + 1);
  const float* origin = of.at[row];
  double sum = 0;
  double squares = 0;
  for (int j = 0; j < count; ++j) {
    const float* p = of.points[static_cast<std::size_t>(of.table.indices(row)[j])];
    double offset = 0;
    for (int a = 0; a < 3; ++a) {
      offset += (static_cast<double>(p[a]) - static_cast<double>(origin[a])) *
                static_cast<double>(normal[a]);
    }
    sum += offset;
    squares += offset * offset;
  }
  if (count < 4 || !isFinite(normal)) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(0.0, squares - sum * sum / count) / (count - 3));
}

}  // namespace segorient::detail
