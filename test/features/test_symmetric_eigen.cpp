// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "symmetric_eigen.h"

using segorient::detail::symmetricEigen;
using segorient::detail::SymmetricEigen3;
using segorient::detail::SymmetricMatrix3;

namespace {

SymmetricMatrix3 packed(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
}

Eigen::Vector3d vectorOf(const SymmetricEigen3& e, int i) {
  return {e.vectors[i][0], e.vectors[i][1], e.vectors[i][2]};
}

TEST(SymmetricEigen, AgreesWithEigenOverManySpreads) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 20000; ++trial) {
    const Eigen::Matrix3d q = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    const Eigen::Vector3d values(std::pow(10.0, 12.0 * uniform(generator)),
                                 std::pow(10.0, 12.0 * uniform(generator)), uniform(generator));
    const Eigen::Matrix3d m = q * values.asDiagonal() * q.transpose();
    const Eigen::Matrix3d symmetric = 0.5 * (m + m.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> oracle(symmetric);
    const SymmetricEigen3 result = symmetricEigen(packed(symmetric));
    const double size = values.cwiseAbs().maxCoeff();
    for (int i = 0; i < 3; ++i) {
      ASSERT_NEAR(result.values[i], oracle.eigenvalues()[i], 1e-14 * size);
      ASSERT_LT((symmetric * vectorOf(result, i) - result.values[i] * vectorOf(result, i)).norm(),
                1e-14 * size);
      ASSERT_NEAR(vectorOf(result, i).norm(), 1.0, 1e-14);
    }
    ASSERT_GT(vectorOf(result, 0).cross(vectorOf(result, 1)).dot(vectorOf(result, 2)), 0.9);
  }
}

TEST(SymmetricEigen, DegenerateMatrices) {
  const SymmetricEigen3 zero = symmetricEigen({0, 0, 0, 0, 0, 0});
  EXPECT_EQ(zero.values[0], 0.0);
  EXPECT_EQ(zero.values[2], 0.0);
  const SymmetricEigen3 unit = symmetricEigen({1, 0, 0, 1, 0, 1});
  EXPECT_EQ(unit.values[0], 1.0);
  EXPECT_EQ(unit.values[2], 1.0);
  const SymmetricEigen3 rank_one = symmetricEigen({1, 1, 1, 1, 1, 1});
  EXPECT_NEAR(rank_one.values[1], 0.0, 1e-15);
  EXPECT_NEAR(rank_one.values[2], 3.0, 1e-14);
  const SymmetricEigen3 huge = symmetricEigen({4e250, 0, 0, 1e250, 0, 2e250});
  EXPECT_DOUBLE_EQ(huge.values[1], 2e250);
  const SymmetricEigen3 bad = symmetricEigen({std::nan(""), 0, 0, 1, 0, 1});
  EXPECT_TRUE(std::isnan(bad.values[0]));
  const SymmetricEigen3 infinite =
      symmetricEigen({std::numeric_limits<double>::infinity(), 0, 0, 1, 0, 1});
  EXPECT_TRUE(std::isnan(infinite.values[0]));
}

}  // namespace
