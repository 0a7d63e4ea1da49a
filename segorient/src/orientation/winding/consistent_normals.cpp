// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/winding/consistent_normals.h"

#include <cmath>
#include <cstddef>

#include "common/dot.h"
#include "orientation/winding/dipole_fields.h"

namespace segorient {
namespace {

// As the article has it.
constexpr int kSteps = 40;

float lengthOf(const float* v) {
  return std::sqrt(dot(v, v));
}

// Dipoles over areas, 4 floats a point, while they are sought.
class Descent {
 public:
  Descent(const PointView& points, const std::vector<float>& areas, int threads)
      : points_(points), areas_(areas), threads_(threads), strength_(4 * points.size, 0.F) {}

  // Less of sum area (w - 1/2)^2. \return false where nothing would change
  bool step(float radius) {
    const std::vector<float> winding = windingOf(strength_, radius);
    std::vector<float> lack(strength_.size(), 0.F);
    for (std::size_t i = 0; i < points_.size; ++i) {
      lack[4 * i] = areas_[i] * (0.5F - winding[i]);
      lack[4 * i + 3] = areas_[i];
    }
    const std::vector<float> way = windingPulls(points_, {points_, lack}, radius, threads_);
    const std::vector<float> change = windingOf(way, radius);
    double squares = 0.0;
    double bend = 0.0;
    for (std::size_t i = 0; i < points_.size; ++i) {
      const auto area = static_cast<double>(areas_[i]);
      const auto grows = static_cast<double>(change[i]);
      squares += area * static_cast<double>(dot(&way[4 * i], &way[4 * i]));
      bend += area * grows * grows;
    }
    const auto length = static_cast<float>(squares / bend);
    if (!std::isfinite(length)) return false;
    for (std::size_t i = 0; i < strength_.size(); ++i) strength_[i] += length * way[i];
    return true;
  }

  // Each dipole the way that w falls, as strong as it is.
  void turn(float radius, ConsistentNormals& out) {
    const std::vector<float> falls = fallsOf(radius);
    for (std::size_t i = 0; i < points_.size; ++i) {
      const float fall = lengthOf(&falls[4 * i]);
      if (!(fall > 0.F)) continue;
      const float strength = lengthOf(&strength_[4 * i]);
      for (std::size_t a = 0; a < 3; ++a) {
        out.normals[4 * i + a] = falls[4 * i + a] / fall;
        strength_[4 * i + a] = strength * out.normals[4 * i + a];
      }
    }
  }

  void measureSteepness(float radius, ConsistentNormals& out) const {
    const std::vector<float> falls = fallsOf(radius);
    for (std::size_t i = 0; i < points_.size; ++i) {
      // A plane's falls by 1 / (2 radius).
      out.steepness[i] = 2.F * radius * dot(&out.normals[4 * i], &falls[4 * i]);
    }
  }

 private:
  std::vector<float> windingOf(const std::vector<float>& strength, float radius) const {
    const std::vector<float> dipoles = dipolesOf(strength, areas_);
    return windingNumbers(points_, {points_, dipoles}, radius, threads_);
  }

  std::vector<float> fallsOf(float radius) const {
    const std::vector<float> dipoles = dipolesOf(strength_, areas_);
    return steepestDescents(points_, {points_, dipoles}, radius, threads_);
  }

  const PointView& points_;
  const std::vector<float>& areas_;
  int threads_;
  std::vector<float> strength_;
};

}  // namespace

ConsistentNormals consistentNormals(const PointView& points, const std::vector<float>& areas,
                                    const ShrinkingRadius& radius, int threads) {
  ConsistentNormals out;
  out.normals.assign(4 * points.size, 0.F);
  out.steepness.assign(points.size, 0.F);
  Descent descent(points, areas, threads);
  for (int step = 0; step < kSteps; ++step) {
    const float done = static_cast<float>(step) / static_cast<float>(kSteps - 1);
    const float now = radius.first + done * (radius.last - radius.first);
    if (!descent.step(now)) break;
    descent.turn(now, out);
  }
  descent.measureSteepness(radius.first, out);
  return out;
}

}  // namespace segorient
