// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "feature_clouds.h"
#include "features/local_normals.h"

namespace segorient::test {
namespace {

std::vector<float> normalsBy(NormalEstimator estimator, const Sample& sample,
                             const Neighborhoods& table, std::vector<LocalCurvature>* curvatures) {
  LocalNormalOptions options;
  options.estimator = estimator;
  std::vector<float> normals(4 * sample.normals.size());
  if (curvatures) curvatures->resize(sample.normals.size());
  estimateNormals(sample.view(), sample.view(), table, options, normals.data(),
                  curvatures ? curvatures->data() : nullptr);
  return normals;
}

/// Least squares by QR in double precision over the plane's frame.
Eigen::Vector3d surfaceOracle(const Sample& sample, const Neighborhoods& table, std::size_t i,
                              const Eigen::Vector3d& guess, int degree) {
  const Eigen::Vector3d u = guess.unitOrthogonal();
  const Eigen::Vector3d v = guess.cross(u);
  const Eigen::Index terms = degree == 3 ? 10 : 6;
  Eigen::MatrixXd a(table.count(i), terms);
  Eigen::VectorXd b(table.count(i));
  for (int j = 0; j < table.count(i); ++j) {
    const auto q = static_cast<std::size_t>(table.indices(i)[j]);
    const Eigen::Vector3d d = 10 * (sample.points[q].getVector3fMap().cast<double>() -
                                    sample.points[i].getVector3fMap().cast<double>());
    const double x = d.dot(u);
    const double y = d.dot(v);
    Eigen::VectorXd row(10);
    row << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
    a.row(j) = row.head(terms);
    b[j] = d.dot(guess);
  }
  const Eigen::VectorXd c = a.colPivHouseholderQr().solve(b);
  return (guess - c[1] * u - c[2] * v).normalized();
}

TEST(SurfaceFit, IsTheLeastSquaresSurface) {
  const Sample smooth = torus(3000, 1);
  const Sample noisy = torus(3000, 2, 0.3F * torusSpacing(3000));
  for (const Sample* sample : {&smooth, &noisy}) {
    const Neighborhoods table = neighborsOf(sample->view(), 25);
    const std::vector<float> planes = normalsBy(NormalEstimator::PLANE, *sample, table, nullptr);
    for (const int degree : {2, 3}) {
      const std::vector<float> normals =
          normalsBy(degree == 3 ? NormalEstimator::AWAS_CUBIC : NormalEstimator::AWAS_QUADRATIC,
                    *sample, table, nullptr);
      for (std::size_t i = 0; i < sample->normals.size(); ++i) {
        const Eigen::Vector3d guess(planes[4 * i], planes[4 * i + 1], planes[4 * i + 2]);
        const Eigen::Vector3d expected = surfaceOracle(*sample, table, i, guess, degree);
        ASSERT_LT(angleBetween(expected.cast<float>(), &normals[4 * i]), 2e-5);
      }
    }
  }
}

TEST(SurfaceFit, OrdersOfAccuracyOnATorus) {
  const Sample sample = torus(100000, 3);
  const Neighborhoods table = neighborsOf(sample.view(), 10);
  const auto rms = [&](NormalEstimator estimator) {
    return rmsDegrees(sample, normalsBy(estimator, sample, table, nullptr));
  };
  EXPECT_LT(rms(NormalEstimator::AWAS_QUADRATIC), 0.03);
  EXPECT_LT(rms(NormalEstimator::AWAS_CUBIC), 0.01);
  EXPECT_GT(rms(NormalEstimator::PLANE), 0.1);
}

TEST(SurfaceFit, CurvaturesOfASphereAndATorus) {
  std::vector<LocalCurvature> curvatures;
  const Sample ball = sphere(5000, 4);
  std::vector<float> normals =
      normalsBy(NormalEstimator::AWAS_QUADRATIC, ball, neighborsOf(ball.view(), 20), &curvatures);
  for (std::size_t i = 0; i < ball.normals.size(); ++i) {
    // Seen along the outward normal a sphere bends away.
    const float outward = ball.normals[i].dot(Eigen::Map<Eigen::Vector3f>(&normals[4 * i]));
    ASSERT_NEAR(curvatures[i].pc1 * outward, -1.F, 0.1F);
    ASSERT_NEAR(curvatures[i].pc2 * outward, -1.F, 0.1F);
  }
  const Sample ring = torus(40000, 4);
  for (const auto estimator : {NormalEstimator::AWAS_QUADRATIC, NormalEstimator::AWAS_CUBIC}) {
    normals = normalsBy(estimator, ring, neighborsOf(ring.view(), 25), &curvatures);
    for (std::size_t i = 0; i < ring.normals.size(); ++i) {
      const Eigen::Vector3f& n = ring.normals[i];
      const Eigen::Vector3f p = ring.points[i].getVector3fMap();
      const float outward = n.dot(Eigen::Map<Eigen::Vector3f>(&normals[4 * i]));
      const float distance = std::hypot(p.x(), p.y());  // from the axis
      const float around = -(distance - 1.F) / 0.4F / distance;
      ASSERT_NEAR(curvatures[i].pc1 * outward, -2.5F, 0.15F);
      ASSERT_NEAR(curvatures[i].pc2 * outward, around, 0.15F);
      const Eigen::Vector3f axis = Eigen::Vector3f(-p.y(), p.x(), 0.F) / distance;
      const Eigen::Map<const Eigen::Vector3f> direction(curvatures[i].direction);
      ASSERT_NEAR(direction.norm(), 1.F, 1e-5F);
      ASSERT_LT(std::abs(direction.dot(axis)), 0.1F);
      ASSERT_LT(std::abs(direction.dot(n)), 0.01F);
    }
  }
}

// Neighbours on two lines determine a plane but no surface.
TEST(SurfaceFit, FallsBackToTheFirstGuess) {
  Sample lines;
  for (int i = 0; i < 200; ++i) {
    lines.add({0.01F * static_cast<float>(i), 0.F, 0.F}, Eigen::Vector3f::UnitZ());
    lines.add({0.01F * static_cast<float>(i) + 0.003F, 0.02F, 0.F}, Eigen::Vector3f::UnitZ());
  }
  const Neighborhoods table = neighborsOf(lines.view(), 12);
  std::vector<LocalCurvature> curvatures;
  const std::vector<float> planes = normalsBy(NormalEstimator::PLANE, lines, table, nullptr);
  for (const auto estimator : {NormalEstimator::AWAS_QUADRATIC, NormalEstimator::AWAS_CUBIC}) {
    EXPECT_EQ(normalsBy(estimator, lines, table, &curvatures), planes);
    EXPECT_TRUE(std::all_of(curvatures.begin(), curvatures.end(),
                            [](const LocalCurvature& c) { return std::isnan(c.pc1); }));
  }
  const Sample few = torus(7, 1);  // enough for a quadratic surface, not for a cubic one
  const Neighborhoods all = neighborsOf(few.view(), 6);
  EXPECT_EQ(normalsBy(NormalEstimator::AWAS_CUBIC, few, all, nullptr),
            normalsBy(NormalEstimator::AWAS_QUADRATIC, few, all, nullptr));
}

TEST(SurfaceFit, FirstGuessHardlyMattersOnSmoothSurfaces) {
  const Sample sample = torus(20000, 6);
  const Neighborhoods table = neighborsOf(sample.view(), 12);
  LocalNormalOptions options;
  options.estimator = NormalEstimator::AWAS_QUADRATIC;
  for (const auto guess : {NormalEstimator::PLANE, NormalEstimator::LCT, NormalEstimator::LDT}) {
    options.first_guess = guess;
    std::vector<float> normals(4 * sample.normals.size());
    estimateNormals(sample.view(), table, options, normals.data());
    EXPECT_LT(rmsDegrees(sample, normals), 0.1);
  }
}

}  // namespace
}  // namespace segorient::test
