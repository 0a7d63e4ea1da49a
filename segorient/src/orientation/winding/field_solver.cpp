// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/field_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/dot.h"
#include "orientation/winding/dipole_fields.h"

namespace segorient {
namespace {

constexpr int kNearest = 8;       // neighbours that make pairs
constexpr float kInFront = 1.5F;  // in radii of the smoothing: beyond what that blurs

// \return whether there is a direction
bool normalize(const float* from, float length, float* to) {
  const auto square = [](float v) { return static_cast<double>(v) * static_cast<double>(v); };
  const double now = std::sqrt(square(from[0]) + square(from[1]) + square(from[2]));
  if (!std::isfinite(now) || !(now > 0.0)) return false;
  for (std::size_t a = 0; a < 3; ++a) {
    to[a] = static_cast<float>(static_cast<double>(length) * static_cast<double>(from[a]) / now);
  }
  return true;
}

}  // namespace

FieldSolver::FieldSolver(const PointView& points, const Neighborhoods& neighborhoods,
                         const std::vector<float>& areas, float radius, int threads)
    : points_(points),
      neighborhoods_(neighborhoods),
      areas_(areas),
      radius_(radius),
      threads_(threads) {}

std::vector<float> FieldSolver::dipolesOf(const std::vector<float>& normals) const {
  std::vector<float> dipoles(4 * points_.size, 0.F);
  for (std::size_t i = 0; i < points_.size; ++i) {
    for (std::size_t a = 0; a < 3; ++a) dipoles[4 * i + a] = areas_[i] * normals[4 * i + a];
    dipoles[4 * i + 3] = areas_[i];
  }
  return dipoles;
}

std::vector<float> FieldSolver::windingOf(const std::vector<float>& normals,
                                          const std::vector<std::uint32_t>* rows) const {
  const std::vector<float> dipoles = dipolesOf(normals);
  return windingNumbers(points_, {points_, dipoles, rows}, radius_, threads_);
}

// The step along the gradient of the sum of area (1/2 - w)^2 that lowers it most.
void FieldSolver::step(std::vector<float>& dipoles, bool is_first) const {
  const std::size_t n = points_.size;
  std::vector<float> lack(4 * n, 0.F);  // area (1/2 - w), and the area for the tree
  std::vector<float> winding(n, 0.F);
  if (!is_first) winding = windingNumbers(points_, {points_, dipoles}, radius_, threads_);
  for (std::size_t i = 0; i < n; ++i) {
    lack[4 * i] = areas_[i] * (0.5F - winding[i]);
    lack[4 * i + 3] = areas_[i];
  }
  std::vector<float> way = windingPulls(points_, {points_, lack}, radius_, threads_);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < 3; ++a) way[4 * i + a] *= areas_[i];
    way[4 * i + 3] = areas_[i];
  }
  const std::vector<float> change = windingNumbers(points_, {points_, way}, radius_, threads_);
  double gain = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto c = static_cast<double>(change[i]);
    gain += static_cast<double>(lack[4 * i]) * c;
    squares += static_cast<double>(areas_[i]) * c * c;
  }
  if (!(squares > 0.0) || !std::isfinite(gain / squares)) return;
  const auto length = static_cast<float>(gain / squares);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < 3; ++a) dipoles[4 * i + a] += length * way[4 * i + a];
  }
}

std::vector<float> FieldSolver::relax(std::vector<float> normals, int rounds) const {
  const bool from_nothing =
      std::all_of(normals.begin(), normals.end(), [](float v) { return v == 0.F; });
  std::vector<float> dipoles = dipolesOf(normals);
  for (int round = 0; round < rounds; ++round) {
    step(dipoles, from_nothing && round == 0);
    const std::vector<float> field =
        steepestDescents(points_, {points_, dipoles}, radius_, threads_);
    for (std::size_t i = 0; i < points_.size; ++i) {
      normalize(&field[4 * i], areas_[i], &dipoles[4 * i]);
    }
  }
  for (std::size_t i = 0; i < points_.size; ++i) normalize(&dipoles[4 * i], 1.F, &normals[4 * i]);
  return normals;
}

float FieldSolver::spreadOf(const std::vector<float>& winding, float* factor) const {
  double area = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < winding.size(); ++i) {
    const auto a = static_cast<double>(areas_[i]);
    const auto w = static_cast<double>(winding[i]);
    area += a;
    sum += a * w;
    squares += a * w * w;
  }
  if (!(squares * area > 0.0)) return 0.25F;
  if (factor != nullptr) *factor = static_cast<float>(0.5 * sum / squares);
  return static_cast<float>(0.25 - 0.25 * sum * sum / (squares * area));
}

float FieldSolver::outside(const std::vector<float>& normals, float way, float factor) const {
  const std::size_t n = points_.size;
  std::vector<float> before(4 * n, 0.F);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      before[4 * i + a] = points_[i][a] + way * kInFront * radius_ * normals[4 * i + a];
    }
  }
  const std::vector<float> dipoles = dipolesOf(normals);
  const std::vector<float> winding =
      windingNumbers({before.data(), 4, n}, {points_, dipoles}, radius_, threads_);
  double area = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto a = static_cast<double>(areas_[i]);
    area += a;
    sum += a * static_cast<double>(std::min(0.5F, std::fabs(factor * winding[i])));
  }
  return area > 0.0 ? static_cast<float>(sum / area) : 0.F;
}

FieldEnergy FieldSolver::energy(const std::vector<float>& normals) const {
  const std::size_t n = points_.size;
  FieldEnergy out;
  float factor = 0.F;
  out.spread = spreadOf(windingOf(normals), &factor);
  out.outside = std::min(outside(normals, 1.F, factor), outside(normals, -1.F, factor));
  double opposed = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const int count = std::min(neighborhoods_.count(i), kNearest + 1);
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(neighborhoods_.indices(i)[j]);
      opposed += static_cast<double>(std::max(0.F, -dot(&normals[4 * i], &normals[4 * q])));
      pairs += 1.0;
    }
  }
  if (pairs > 0.0) out.opposed = static_cast<float>(opposed / pairs);
  return out;
}

}  // namespace segorient
