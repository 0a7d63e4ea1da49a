// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include "labelled_solids.h"

namespace segorient::test {

/// Part of a sphere around c: those directions that `keep` wants. outward < 0 for the wall of a
/// cavity.
inline Face spherePart(const Eigen::Vector3d& c, double r, double outward, double share,
                       const std::function<bool(const Eigen::Vector3d&)>& keep) {
  return {4 * M_PI * r * r * share, [=](std::mt19937& rng, Eigen::Vector3d& p, Eigen::Vector3d& n) {
            std::normal_distribution<double> normal(0, 1);
            Eigen::Vector3d d;
            do {
              d = Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized();
            } while (!keep(d));
            p = c + r * d;
            n = outward * d;
          }};
}

inline Face sphere(const Eigen::Vector3d& c, double r, double outward = 1) {
  return spherePart(c, r, outward, 1, [](const Eigen::Vector3d&) { return true; });
}

/// An open bowl: the lower half of a sphere, facing away from the centre.
inline Face bowl(const Eigen::Vector3d& c, double r) {
  return spherePart(c, r, 1, 0.5, [](const Eigen::Vector3d& d) { return d.z() < 0; });
}

/// Torus around z.
inline Face torus(double major, double minor) {
  return {4 * M_PI * M_PI * major * minor,
          [=](std::mt19937& rng, Eigen::Vector3d& p, Eigen::Vector3d& n) {
            std::uniform_real_distribution<double> unit(0, 1);
            double t = 0;
            do {
              t = 2 * M_PI * unit(rng);
            } while (unit(rng) * (major + minor) > major + minor * std::cos(t));
            const double s = 2 * M_PI * unit(rng);
            n = Eigen::Vector3d(std::cos(t) * std::cos(s), std::cos(t) * std::sin(s), std::sin(t));
            p = minor * n + major * Eigen::Vector3d(std::cos(s), std::sin(s), 0);
          }};
}

/// Two square faces of side 1 that meet along the y axis: the material between them fills
/// `dihedral` radians. The first one is the lower half plane's lid, facing up.
inline std::vector<Face> wedge(double dihedral) {
  const Eigen::Vector3d along(0, 1, 0);
  const Eigen::Vector3d second(std::cos(dihedral), 0, -std::sin(dihedral));
  return {parallelogram({0, 0, 0}, {1, 0, 0}, along), parallelogram({0, 0, 0}, along, second)};
}

inline PointView pointsOf(const LabelledCloud& cloud) {
  return {cloud.xyz.data(), 4, cloud.size()};
}
inline PointView normalsOf(const LabelledCloud& cloud) {
  return {cloud.normals.data(), 4, cloud.size()};
}

/// The true normals with a random sign each, as an estimator would leave them.
inline std::vector<float> scrambledNormals(const LabelledCloud& cloud, unsigned seed) {
  std::mt19937 rng(seed);
  std::vector<float> out = cloud.normals;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if ((rng() & 1U) == 0) continue;
    for (std::size_t a = 0; a < 3; ++a) out[4 * i + a] = -out[4 * i + a];
  }
  return out;
}

inline float dot3(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Whether a point of another face lies within `spacings` spacings. Brute force.
inline bool isNearEdge(const LabelledCloud& cloud, std::size_t i, double spacings) {
  const double limit = spacings * spacings * cloud.spacing * cloud.spacing;
  const float* const p = &cloud.xyz[4 * i];
  const float* q = cloud.xyz.data();
  for (const auto face : cloud.face) {
    double squared = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = static_cast<double>(p[a]) - q[a];
      squared += d * d;
    }
    if (face != cloud.face[i] && squared < limit) return true;
    q += 4;
  }
  return false;
}

/// How many normals point against the true ones, or are none at all.
struct Agreement {
  std::size_t wrong = 0;
  std::size_t wrong_off_edges = 0;  ///< farther than two spacings from another face
};

inline Agreement compareNormals(const LabelledCloud& cloud, const std::vector<float>& normals) {
  Agreement out;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (dot3(&normals[4 * i], &cloud.normals[4 * i]) > 0) continue;
    ++out.wrong;
    if (!isNearEdge(cloud, i, 2)) ++out.wrong_off_edges;
  }
  return out;
}

}  // namespace segorient::test
