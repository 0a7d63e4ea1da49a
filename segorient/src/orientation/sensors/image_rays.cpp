// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/image_rays.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace segorient::detail {
namespace {

using Projection = Eigen::Matrix<double, 3, 4>;

constexpr std::size_t kSample = 4000;  // pixels that the camera is fitted to
constexpr std::size_t kLeast = 200;    // many times the 11 unknowns, so that errors mean something
// A pixel's own size: real cameras' distortion and rounded depths stay below it.
constexpr double kMostError = 1.0;
// The second best projection must be far worse than the best, else the scene leaves it open.
constexpr double kSecond = 16.0;
constexpr double kInFront = 0.99;

struct Pixels {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> places;
};

Pixels samplePixels(const PointView& points, std::size_t width) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (isFinite(points[i])) rows.push_back(i);
  }
  Pixels out;
  // Not a divisor of the width, or only some columns would be seen: by shares of the number.
  const std::size_t count = std::min(rows.size(), kSample);
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t i = rows[j * rows.size() / count];
    const float* p = points[i];
    out.points.emplace_back(static_cast<double>(p[0]), static_cast<double>(p[1]),
                            static_cast<double>(p[2]));
    const std::size_t line = i / width;
    out.places.emplace_back(static_cast<double>(i % width), static_cast<double>(line));
  }
  return out;
}

// Moved and scaled so that the mean is 0 and the rms distance from it the root of the dimension.
template <typename Vector>
double normalize(std::vector<Vector>& values, Vector& mean) {
  mean.setZero();
  for (const Vector& v : values) mean += v;
  mean /= static_cast<double>(values.size());
  double squares = 0.0;
  for (Vector& v : values) {
    v -= mean;
    squares += v.squaredNorm();
  }
  const double scale =
      std::sqrt(squares / (static_cast<double>(values.size()) * static_cast<double>(mean.size())));
  if (scale > 0.0) {
    for (Vector& v : values) v /= scale;
  }
  return scale;
}

// \return false where the equations leave more than one projection
bool solve(const Pixels& pixels, Projection& out) {
  Eigen::Matrix<double, 12, 12> normal = Eigen::Matrix<double, 12, 12>::Zero();
  for (std::size_t i = 0; i < pixels.points.size(); ++i) {
    Eigen::Vector4d p;
    p << pixels.points[i], 1.0;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      Eigen::Matrix<double, 12, 1> row = Eigen::Matrix<double, 12, 1>::Zero();
      row.segment<4>(4 * axis) = p;
      row.segment<4>(8) = -pixels.places[i][axis] * p;
      normal += row * row.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>> solver(normal);
  if (solver.info() != Eigen::Success) return false;
  const auto& values = solver.eigenvalues();
  const double least = std::max(values[0], 1e-14 * values[11]);
  if (!(values[1] > kSecond * least)) return false;
  for (Eigen::Index r = 0; r < 3; ++r)
    out.row(r) = solver.eigenvectors().col(0).segment<4>(4 * r).transpose();
  return true;
}

struct Errors {
  double median = 0.0;  // distance from the pixel, in units of the normalised image
  double in_front = 0.0;
};

Errors measure(const Pixels& pixels, const Projection& projection) {
  std::vector<double> distances;
  std::size_t positive = 0;
  for (std::size_t i = 0; i < pixels.points.size(); ++i) {
    Eigen::Vector4d p;
    p << pixels.points[i], 1.0;
    const Eigen::Vector3d q = projection * p;
    positive += q[2] > 0.0 ? 1 : 0;
    const double error = (q.head<2>() / q[2] - pixels.places[i]).norm();
    distances.push_back(std::isfinite(error) ? error : 1e30);
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double share = static_cast<double>(positive) / static_cast<double>(distances.size());
  return {*middle, std::max(share, 1.0 - share)};
}

}  // namespace

std::optional<FoundSensor> cameraOfImage(const PointView& points, std::size_t width) {
  if (width < 2 || points.size < 2 * width || points.size % width != 0) return std::nullopt;
  Pixels pixels = samplePixels(points, width);
  if (pixels.points.size() < kLeast) return std::nullopt;
  Eigen::Vector3d center;
  Eigen::Vector2d middle;
  const double unit = normalize(pixels.points, center);
  const double pixel = normalize(pixels.places, middle);
  if (!(unit > 0.0) || !std::isfinite(unit) || !(pixel > 0.0)) return std::nullopt;
  Projection projection;
  if (!solve(pixels, projection)) return std::nullopt;
  const Errors errors = measure(pixels, projection);
  if (!(errors.median * pixel <= kMostError) || errors.in_front < kInFront) return std::nullopt;
  const Eigen::Matrix3d rays = projection.leftCols<3>();
  const Eigen::Vector3d place = -rays.partialPivLu().solve(projection.col(3));
  // The projection's last row is the depth, of either sign.
  Eigen::Vector3d axis = projection.row(2).head<3>().transpose().normalized();
  if (axis.dot(-place) < 0.0) axis = -axis;
  const Eigen::Vector3d position = unit * place + center;
  if (!position.allFinite() || !axis.allFinite()) return std::nullopt;
  FoundSensor out;
  out.kind = SensorKind::CAMERA;
  out.evidence = SensorEvidence::IMAGE;
  for (int a = 0; a < 3; ++a) {
    out.position[static_cast<std::size_t>(a)] = static_cast<float>(position[a]);
    out.axis[static_cast<std::size_t>(a)] = static_cast<float>(axis[a]);
  }
  // In pixels that have a spread of 1 along each side of the image: a share of its size.
  out.cost_ratio = static_cast<float>(errors.median);
  out.sure = true;
  return out;
}

}  // namespace segorient::detail
