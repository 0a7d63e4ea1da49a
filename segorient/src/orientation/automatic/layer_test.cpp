// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/layer_test.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/dot.h"
#include "common/every_nth.h"
#include "common/parallel_for.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {
namespace {

constexpr float kFlat = 0.97F;           // normals within 14 degrees of their mean
constexpr std::size_t kSamples = 20000;  // enough for the scatter to a hundredth
// Between a wall's .18 and the .58 of layers on a sphere, whose noise makes it less.
constexpr float kCross = 0.25F;

// Standard deviation of the offsets of p and its neighbours along a direction.
float thickness(const PointView& points, const Neighborhoods& table, std::size_t p,
                const float* direction) {
  const int count = std::min(table.count(p), kSheetDegree);
  float sum = 0.F;
  float squares = 0.F;
  for (int j = 0; j < count; ++j) {
    const float* q = points[static_cast<std::size_t>(table.indices(p)[j])];
    const float d[3] = {q[0] - points[p][0], q[1] - points[p][1], q[2] - points[p][2]};
    const float offset = dot(d, direction);
    sum += offset;
    squares += offset * offset;
  }
  const auto n = static_cast<float>(std::max(1, count));
  return std::sqrt(std::max(0.F, squares / n - (sum / n) * (sum / n)));
}

// The inverse of the normals' mean square: the square of a normal by it is large for rare ones.
Eigen::Matrix3d rarityOf(const std::vector<Eigen::Vector3d>& normals) {
  constexpr double kLeast = 0.01;  // of a direction that has less surface, single points would tell
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& n : normals) squares += n * n.transpose();
  squares /= std::max(1.0, static_cast<double>(normals.size()));
  return (squares + kLeast * Eigen::Matrix3d::Identity()).inverse();
}

}  // namespace

float thicknessScatter(const PointView& points, const Neighborhoods& neighborhoods,
                       const std::vector<float>& around, int threads) {
  const EveryNth rows(points.size, kSamples);
  std::vector<float> values(rows.size(), -1.F);
  parallelFor(rows.size(), threads, 3000.0, [&](std::size_t r) {
    const float* mean = &around[4 * rows[r]];
    if (mean[3] >= kFlat) values[r] = thickness(points, neighborhoods, rows[r], mean);
  });
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> found;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (values[r] < 0.F) continue;
    const float* n = &around[4 * rows[r]];
    normals.push_back(Eigen::Vector3f(n[0], n[1], n[2]).cast<double>());
    found.push_back(static_cast<double>(values[r]));
  }
  const Eigen::Matrix3d rarity = rarityOf(normals);
  double count = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double weight = normals[i].dot(rarity * normals[i]);
    count += weight;
    sum += weight * found[i];
    squares += weight * found[i] * found[i];
  }
  if (!(sum > 0.0)) return 0.F;
  const double mean = sum / count;
  return static_cast<float>(std::sqrt(std::max(0.0, squares / count - mean * mean)) / mean);
}

bool layersCross(const PointView& points, const Neighborhoods& neighborhoods,
                 const std::vector<float>& around, int threads) {
  return thicknessScatter(points, neighborhoods, around, threads) >= kCross;
}

}  // namespace segorient::detail
