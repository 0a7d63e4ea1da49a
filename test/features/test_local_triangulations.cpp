// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "feature_clouds.h"
#include "features/local_normals.h"

namespace segorient::test {
namespace {

using Offsets = std::vector<Eigen::Vector3d>;

/// The neighbours of a point, itself left out, as offsets from it.
Offsets offsetsOf(const Sample& sample, const Neighborhoods& table, std::size_t i) {
  Offsets offsets;
  for (int j = 1; j < table.count(i); ++j) {
    const auto q = static_cast<std::size_t>(table.indices(i)[j]);
    offsets.push_back(sample.points[q].getVector3fMap().cast<double>() -
                      sample.points[i].getVector3fMap().cast<double>());
  }
  return offsets;
}

Eigen::Vector3d normalAt(const std::vector<float>& normals, std::size_t i) {
  return {normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]};
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

/// The fan as the paper describes it, triangle by triangle.
Eigen::Vector3d fanOracle(const Offsets& offsets, const Eigen::Vector3d& plane_normal) {
  const Eigen::Vector3d u = plane_normal.unitOrthogonal();
  const Eigen::Vector3d v = plane_normal.cross(u);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const auto& d : offsets) center += d / static_cast<double>(offsets.size());
  Offsets sorted = offsets;
  const auto direction = [&](const Eigen::Vector3d& d) {
    return std::atan2((d - center).dot(v), (d - center).dot(u));
  };
  std::sort(sorted.begin(), sorted.end(),
            [&](const auto& a, const auto& b) { return direction(a) < direction(b); });
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t j = 0; j < sorted.size(); ++j) {
    const Eigen::Vector3d& next = sorted[(j + 1) % sorted.size()];
    sum += (sorted[j] - center).cross(next - center);  // twice the area times the unit normal
  }
  return sum.normalized();
}

/// All triangles of the point and two neighbours with an empty circumcircle, by trying every pair.
Eigen::Vector3d delaunayOracle(const Offsets& offsets, const Eigen::Vector3d& plane_normal) {
  const Eigen::Vector3d u = plane_normal.unitOrthogonal();
  const Eigen::Vector3d v = plane_normal.cross(u);
  std::vector<Eigen::Vector2d> flat;
  for (const auto& d : offsets) flat.emplace_back(d.dot(u), d.dot(v));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t a = 0; a < flat.size(); ++a) {
    for (std::size_t b = 0; b < flat.size(); ++b) {
      const double twice_area = flat[a].x() * flat[b].y() - flat[a].y() * flat[b].x();
      if (twice_area <= 0) continue;
      const Eigen::Vector2d center =
          Eigen::Vector2d(
              flat[b].y() * flat[a].squaredNorm() - flat[a].y() * flat[b].squaredNorm(),
              flat[a].x() * flat[b].squaredNorm() - flat[b].x() * flat[a].squaredNorm()) /
          (2 * twice_area);
      bool empty = true;
      for (std::size_t c = 0; c < flat.size() && empty; ++c) {
        empty = c == a || c == b || (flat[c] - center).norm() > center.norm();
      }
      if (empty) sum += offsets[a].cross(offsets[b]).normalized();
    }
  }
  return sum.normalized();
}

std::vector<float> normalsBy(NormalEstimator estimator, const Sample& sample,
                             const Neighborhoods& table) {
  LocalNormalOptions options;
  options.estimator = estimator;
  std::vector<float> normals(4 * sample.normals.size());
  estimateNormals(sample.view(), table, options, normals.data());
  return normals;
}

/// Share of points whose normal is the oracle's. Not all: near ties go either way in float.
template <typename Oracle>
double agreement(NormalEstimator estimator, const Sample& sample, int k, Oracle oracle) {
  const Neighborhoods table = neighborsOf(sample.view(), k);
  const std::vector<float> planes = normalsBy(NormalEstimator::PLANE, sample, table);
  const std::vector<float> normals = normalsBy(estimator, sample, table);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < sample.normals.size(); ++i) {
    const Eigen::Vector3d expected = oracle(offsetsOf(sample, table, i), normalAt(planes, i));
    equal += angle(expected, normalAt(normals, i)) < 2e-4;
  }
  return static_cast<double>(equal) / static_cast<double>(sample.normals.size());
}

TEST(LocalCentreTriangulation, IsTheAreaWeightedFan) {
  const Sample smooth = torus(2000, 1, 0.2F * torusSpacing(2000));
  const Sample edges = cube(2000, 1);
  for (const int k : {4, 10, 37}) {
    EXPECT_GT(agreement(NormalEstimator::LCT, smooth, k, fanOracle), 0.995) << k;
    EXPECT_GT(agreement(NormalEstimator::LCT, edges, k, fanOracle), 0.995) << k;
  }
}

TEST(LocalDelaunayTriangulation, IsTheDelaunayStar) {
  const Sample smooth = torus(2000, 2, 0.2F * torusSpacing(2000));
  const Sample edges = cube(2000, 2);  // points on the hull of their neighbours among them
  for (const int k : {4, 10, 37}) {
    EXPECT_GT(agreement(NormalEstimator::LDT, smooth, k, delaunayOracle), 0.995) << k;
    EXPECT_GT(agreement(NormalEstimator::LDT, edges, k, delaunayOracle), 0.99) << k;
  }
}

TEST(LocalTriangulations, ExactOnPlanesAndGrids) {
  Sample grid;  // cocircular and collinear neighbours everywhere
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      grid.add({0.25F * static_cast<float>(i), 0.25F * static_cast<float>(j), 3.F},
               Eigen::Vector3f::UnitZ());
    }
  }
  const Sample tilted = plane(3000, 3, Eigen::Vector3f(1, -2, 3).normalized());
  for (const Sample* sample : std::initializer_list<const Sample*>{&grid, &tilted}) {
    const Neighborhoods table = neighborsOf(sample->view(), 12);
    for (const auto estimator : {NormalEstimator::LCT, NormalEstimator::LDT}) {
      EXPECT_LT(rmsDegrees(*sample, normalsBy(estimator, *sample, table)), 0.01);
    }
  }
}

// What each is for, as the paper reports it: LDT at clean edges, LCT under noise.
TEST(LocalTriangulations, StrengthsAndWeaknesses) {
  const Sample edges = cube(12000, 4);
  const Sample noisy = torus(12000, 4, 0.25F * torusSpacing(12000));
  const auto near = [&](NormalEstimator estimator) {
    const std::vector<float> n = normalsBy(estimator, edges, neighborsOf(edges.view(), 10));
    std::size_t good = 0;
    for (std::size_t i = 0; i < edges.normals.size(); ++i) {
      good += angleBetween(edges.normals[i], &n[4 * i]) < 10 * kDegree;
    }
    return good;
  };
  EXPECT_GT(near(NormalEstimator::LDT), near(NormalEstimator::LCT));
  const Neighborhoods table = neighborsOf(noisy.view(), 30);
  const double plane = rmsDegrees(noisy, normalsBy(NormalEstimator::PLANE, noisy, table));
  const double lct = rmsDegrees(noisy, normalsBy(NormalEstimator::LCT, noisy, table));
  const double ldt = rmsDegrees(noisy, normalsBy(NormalEstimator::LDT, noisy, table));
  EXPECT_LT(plane, lct);
  EXPECT_LT(lct, ldt);
}

// Beyond 64 neighbours the sorting keys change their layout.
TEST(LocalTriangulations, ManyNeighbors) {
  const Sample sample = torus(20000, 5);
  const Neighborhoods table = neighborsOf(sample.view(), 300);
  EXPECT_LT(rmsDegrees(sample, normalsBy(NormalEstimator::LCT, sample, table)), 12.0);
  EXPECT_LT(rmsDegrees(sample, normalsBy(NormalEstimator::LDT, sample, table)), 2.5);
}

}  // namespace
}  // namespace segorient::test
