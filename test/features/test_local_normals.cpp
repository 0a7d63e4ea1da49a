// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "feature_clouds.h"
#include "features/local_normals.h"

namespace segorient::test {
namespace {

std::vector<float> normalsOf(const PointView& points, const Neighborhoods& table,
                             const LocalNormalOptions& options) {
  std::vector<float> normals(4 * points.size);
  estimateNormals(points, table, options, normals.data());
  return normals;
}

Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> planeOracle(const PointView& points,
                                                           const pcl::index_t* row, int count) {
  const auto point = [&](int j) {
    const float* p = points[static_cast<std::size_t>(row[j])];
    return Eigen::Vector3d(p[0], p[1], p[2]);
  };
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int j = 0; j < count; ++j) mean += point(j) / count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int j = 0; j < count; ++j) {
    covariance += (point(j) - mean) * (point(j) - mean).transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance);
}

/// Difference from the double-precision plane, weighted by how well the plane is determined.
double worstPlaneError(const PointView& points, const Neighborhoods& table, int k,
                       const std::vector<float>& normals) {
  double worst = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto oracle = planeOracle(points, table.indices(i), std::min(table.count(i), k + 1));
    const Eigen::Vector3d values = oracle.eigenvalues();
    const Eigen::Vector3f normal = oracle.eigenvectors().col(0).cast<float>();
    const double angle = angleBetween(normal, &normals[4 * i]);
    worst = std::max(worst, angle * (values[1] - values[0]) / values[1]);
    worst = std::max(worst, std::abs(values[0] / values.sum() - normals[4 * i + 3]));
  }
  return worst;
}

TEST(PlaneFit, AgreesWithDoublePrecision) {
  const Sample smooth = torus(20000, 1);
  const Sample edges = cube(20000, 2);
  const Sample noisy = torus(20000, 3, 1.5F * torusSpacing(20000));
  for (const Sample* sample : {&smooth, &edges, &noisy}) {
    const Neighborhoods table = neighborsOf(sample->view(), 30);
    for (const int k : {3, 10, 30}) {
      LocalNormalOptions options;
      options.k = k;
      EXPECT_LT(
          worstPlaneError(sample->view(), table, k, normalsOf(sample->view(), table, options)),
          2e-5);
    }
  }
}

// Scan lines: the points of a neighbourhood lie almost on one line.
TEST(PlaneFit, SlimNeighborhoods) {
  Sample lines;
  std::mt19937 generator(5);
  std::normal_distribution<float> gauss(0.F, 1.F);
  for (int i = 0; i < 4000; ++i) {
    const float along = 0.01F * static_cast<float>(i);
    lines.add({along, 1e-4F * gauss(generator), 2e-6F * gauss(generator)},
              Eigen::Vector3f::UnitZ());
  }
  const Neighborhoods table = neighborsOf(lines.view(), 12);
  const std::vector<float> normals = normalsOf(lines.view(), table, {});
  EXPECT_LT(worstPlaneError(lines.view(), table, 12, normals), 1e-6);
}

TEST(PlaneFit, CurvatureOfPlaneAndSphere) {
  const Sample flat = plane(5000, 3, Eigen::Vector3f(1, 2, 3).normalized());
  const Sample ball = sphere(5000, 3);
  const std::vector<float> a = normalsOf(flat.view(), neighborsOf(flat.view(), 20), {});
  const std::vector<float> b = normalsOf(ball.view(), neighborsOf(ball.view(), 20), {});
  EXPECT_LT(rmsDegrees(flat, a), 1e-3);
  EXPECT_LT(rmsDegrees(ball, b), 1.5);
  for (std::size_t i = 0; i < flat.normals.size(); ++i) {
    ASSERT_GE(a[4 * i + 3], 0.F);
    ASSERT_LT(a[4 * i + 3], 1e-6F);
    ASSERT_GT(b[4 * i + 3], 0.F);
    ASSERT_LT(b[4 * i + 3], 0.01F);
  }
}

class AnyEstimator : public testing::TestWithParam<NormalEstimator> {
 protected:
  LocalNormalOptions options() const {
    LocalNormalOptions o;
    o.estimator = GetParam();
    return o;
  }
};

TEST_P(AnyEstimator, SameBitsForAnyThreadsAndInstructionSet) {
  const Sample sample = torus(10007, 4, 0.3F * torusSpacing(10007));
  const Neighborhoods table = neighborsOf(sample.view(), 13);
  LocalNormalOptions o = options();
  o.k = 12;
  o.threads = 1;
  const std::vector<float> reference = normalsOf(sample.view(), table, o);
  for (const int threads : {2, 4}) {
    o.threads = threads;
    EXPECT_EQ(normalsOf(sample.view(), table, o), reference);
  }
  for (const char* instruction_set : {"avx512", "avx2", "sse2"}) {
    setenv("SEGORIENT_SIMD", instruction_set, 1);
    EXPECT_EQ(normalsOf(sample.view(), table, o), reference) << instruction_set;
    unsetenv("SEGORIENT_SIMD");
  }
  o.portable = true;
  EXPECT_EQ(normalsOf(sample.view(), table, o), reference);
}

// A row may have the point itself, and copies of it, in any place.
TEST_P(AnyEstimator, CopiesOfThePointWhereverTheyStand) {
  const Sample sample = torus(2000, 5, 0.2F * torusSpacing(2000));
  const Neighborhoods table = neighborsOf(sample.view(), 14);
  Neighborhoods first;
  Neighborhoods last;
  for (Neighborhoods* copies : {&first, &last}) copies->reset(table.size(), 17, false);
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::fill_n(first.mutableIndices(i), 3, static_cast<pcl::index_t>(i));
    std::copy_n(table.indices(i) + 1, 14, first.mutableIndices(i) + 3);
    std::copy_n(table.indices(i) + 1, 14, last.mutableIndices(i));
    std::fill_n(last.mutableIndices(i) + 14, 3, static_cast<pcl::index_t>(i));
    first.setCount(i, 17);
    last.setCount(i, 17);
  }
  const std::vector<float> expected = normalsOf(sample.view(), first, options());
  const std::vector<float> normals = normalsOf(sample.view(), last, options());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> n(&expected[4 * i]);
    EXPECT_LT(angleBetween(n, &normals[4 * i]), 1e-4) << i;
  }
}

// As a search surface of its own the same cloud gives the same normals.
TEST_P(AnyEstimator, TheSameCloudAsItsOwnSurface) {
  const Sample sample = torus(2000, 5);
  const Sample copy = sample;
  const Neighborhoods table = neighborsOf(sample.view(), 12);
  std::vector<float> normals(4 * sample.normals.size());
  estimateNormals(sample.view(), copy.view(), table, options(), normals.data());
  EXPECT_EQ(normals, normalsOf(sample.view(), table, options()));
}

TEST_P(AnyEstimator, FarFromTheOrigin) {
  const Eigen::Vector3f far(1e6F, -1e6F, 1e6F);
  // Coordinates that 1e6 more can still represent: multiples of 1/16, in a cloud 4,000 wide.
  Sample near = torus(5000, 6);
  Sample moved;
  for (std::size_t i = 0; i < near.normals.size(); ++i) {
    for (float& c : near.points[i].data) c = std::round(c * 2000.F * 16.F) / 16.F;
    near.points[i].data[3] = 1.F;
    moved.add(near.points[i].getVector3fMap() + far, near.normals[i]);
  }
  const Neighborhoods table = neighborsOf(near.view(), 12);
  EXPECT_EQ(normalsOf(near.view(), table, options()), normalsOf(moved.view(), table, options()));
}

TEST_P(AnyEstimator, ScaleDoesNotMatter) {
  const Sample sample = torus(3000, 8);
  const Neighborhoods table = neighborsOf(sample.view(), 12);
  const std::vector<float> reference = normalsOf(sample.view(), table, options());
  for (const float scale : {1e-40F, 1e-30F, 1e-18F, 1e-10F, 1e10F, 1e18F, 1e30F}) {
    Sample scaled;
    for (std::size_t i = 0; i < sample.normals.size(); ++i) {
      scaled.add(scale * sample.points[i].getVector3fMap(), sample.normals[i]);
    }
    const std::vector<float> normals = normalsOf(scaled.view(), table, options());
    for (std::size_t i = 0; i < sample.normals.size(); ++i) {
      const Eigen::Vector3f n(reference[4 * i], reference[4 * i + 1], reference[4 * i + 2]);
      // Below 1e-38 floats have few digits: other triangles may be the Delaunay ones.
      ASSERT_LT(angleBetween(n, &normals[4 * i]), scale < 1e-38F ? 0.1 : 1e-3) << scale;
    }
  }
}

TEST_P(AnyEstimator, NoPlane) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto allUndefined = [&](const Sample& sample, int k) {
    const std::vector<float> n = normalsOf(sample.view(), neighborsOf(sample.view(), k), options());
    return std::all_of(n.begin(), n.end(), [](float x) { return std::isnan(x); });
  };
  Sample one, two, same, line, bad;
  one.add({1, 2, 3}, Eigen::Vector3f::Zero());
  two.add({1, 2, 3}, Eigen::Vector3f::Zero());
  two.add({1, 2, 4}, Eigen::Vector3f::Zero());
  for (int i = 0; i < 100; ++i) {
    same.add({1, 2, 3}, Eigen::Vector3f::Zero());
    line.add((0.1F + 0.013F * static_cast<float>(i)) * Eigen::Vector3f(0.3F, 0.7F, -0.2F),
             Eigen::Vector3f::Zero());
    bad.add({kNaN, 1, 2}, Eigen::Vector3f::Zero());
  }
  EXPECT_TRUE(allUndefined(one, 5));
  EXPECT_TRUE(allUndefined(two, 5));
  EXPECT_TRUE(allUndefined(same, 5));
  EXPECT_TRUE(allUndefined(line, 9));
  EXPECT_TRUE(allUndefined(bad, 5));
}

TEST_P(AnyEstimator, UnevenRows) {
  const Sample sample = torus(2000, 9);
  Neighborhoods table = neighborsOf(sample.view(), 20);
  std::vector<float> expected(4 * sample.normals.size());
  for (std::size_t i = 0; i < sample.normals.size(); ++i) {
    LocalNormalOptions o = options();
    o.k = 7 + static_cast<int>(i % 13);
    const std::vector<pcl::index_t> row{static_cast<pcl::index_t>(i)};
    estimateNormals(sample.view(), sample.view(), table, o, expected.data(), nullptr, &row);
  }
  for (std::size_t i = 0; i < sample.normals.size(); ++i) {
    table.setCount(i, 8 + static_cast<int>(i % 13));
  }
  const std::vector<float> normals = normalsOf(sample.view(), table, options());
  for (std::size_t i = 0; i < normals.size(); ++i) ASSERT_EQ(normals[i], expected[i]) << i;
}

// On a grid angles tie; what breaks the ties may not come from the longer rows beside.
TEST_P(AnyEstimator, TiesDoNotDependOnOtherRows) {
  Sample grid;
  std::mt19937 generator(7);
  std::normal_distribution<float> noise(0.F, 0.02F);
  for (int i = 0; i < 1600; ++i) {
    const auto x = static_cast<float>(i % 40);
    const auto y = static_cast<float>(i / 40);
    grid.add({x, y, noise(generator)}, Eigen::Vector3f::UnitZ());
  }
  Neighborhoods table = neighborsOf(grid.view(), 199);
  for (std::size_t i = 0; i < table.size(); ++i) table.setCount(i, i / 8 % 2 == 0 ? 32 : 200);
  LocalNormalOptions o = options();
  const std::vector<float> normals = normalsOf(grid.view(), table, o);
  std::vector<float> alone(normals.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::vector<pcl::index_t> row{static_cast<pcl::index_t>(i)};
    estimateNormals(grid.view(), grid.view(), table, o, alone.data(), nullptr, &row);
  }
  EXPECT_EQ(normals, alone);
  o.portable = true;
  EXPECT_EQ(normals, normalsOf(grid.view(), table, o));
}

// Every second point of an array as a query for all of them: row 5 is not point 5.
TEST_P(AnyEstimator, QueriesAndPointsOfOneArray) {
  const Sample sample = torus(1000, 12);
  const PointView points = sample.view();
  const PointView queries{points.data, 2 * points.stride, points.size / 2};
  const Neighborhoods all = neighborsOf(points, 12);
  Neighborhoods table;
  table.reset(queries.size, 13, false);
  std::vector<float> copy;
  for (std::size_t row = 0; row < queries.size; ++row) {
    std::copy_n(all.indices(2 * row), 13, table.mutableIndices(row));
    table.mutableIndices(row)[0] = static_cast<pcl::index_t>(row);
    table.setCount(row, 13);
    copy.insert(copy.end(), queries[row], queries[row] + 4);
  }
  std::vector<float> normals(4 * queries.size);
  std::vector<float> expected(4 * queries.size);
  estimateNormals(queries, points, table, options(), normals.data());
  estimateNormals({copy.data(), 4, queries.size}, points, table, options(), expected.data());
  EXPECT_EQ(normals, expected);
}

INSTANTIATE_TEST_SUITE_P(Estimators, AnyEstimator,
                         testing::Values(NormalEstimator::PLANE, NormalEstimator::LCT,
                                         NormalEstimator::LDT, NormalEstimator::AWAS_QUADRATIC,
                                         NormalEstimator::AWAS_CUBIC));

}  // namespace
}  // namespace segorient::test
