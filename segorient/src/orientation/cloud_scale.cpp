// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/cloud_scale.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/median.h"

namespace segorient {
namespace {

constexpr std::size_t kSample = 4000;  // medians of so many are sure to some percent
constexpr int kNear = 6;               // the first ring of neighbours on a surface
constexpr int kFit = 18;               // the first two rings

// Root of the smallest eigenvalue of the covariance.
double planeResidual(const PointView& points, const float* origin, const pcl::index_t* rows,
                     int count) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (int j = 0; j < count; ++j) {
    const float* q = points[static_cast<std::size_t>(rows[j])];
    const Eigen::Vector3d d(static_cast<double>(q[0]) - origin[0],
                            static_cast<double>(q[1]) - origin[1],
                            static_cast<double>(q[2]) - origin[2]);
    mean += d;
    moments += d * d.transpose();
  }
  mean /= count;
  moments = moments / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

}  // namespace

CloudScale measureScale(const PointView& points, const search::MedianHashIndex& index) {
  std::vector<float> spacings;
  std::vector<float> residuals;
  std::array<pcl::index_t, kFit + 1> rows{};
  std::array<float, kFit + 1> squared{};
  const std::size_t samples = std::min(points.size, kSample);
  for (std::size_t i = 0; i < samples; ++i) {
    const float* p = points[i * points.size / samples];
    const int found = index.nearestK(p, kFit + 1, rows.data(), squared.data());
    const int near = std::min(found, kNear + 1);
    if (near < 2) continue;
    float sum = 0.F;
    for (int j = 1; j < near; ++j) sum += std::sqrt(squared[static_cast<std::size_t>(j)]);
    const float spacing = sum / static_cast<float>(near - 1);
    spacings.push_back(spacing);
    if (found < 4 || !(spacing > 0.F)) continue;
    residuals.push_back(static_cast<float>(planeResidual(points, p, rows.data(), found) / spacing));
  }
  CloudScale scale;
  scale.spacing = median(std::move(spacings));
  scale.noise = median(std::move(residuals));
  return scale;
}

int neighborsForNoise(float noise) {
  if (noise < 0.15F) return 12;
  return noise < 0.28F ? 18 : 30;
}

}  // namespace segorient
