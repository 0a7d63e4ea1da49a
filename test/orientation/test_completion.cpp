// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "orientation/paper/completion.h"
#include "orientation/paper/hoppe_tree.h"
#include "oriented_shapes.h"

namespace segorient {
namespace {

using test::LabelledCloud;

Neighborhoods neighborsOf(const LabelledCloud& cloud, int k) {
  search::MedianHashIndex index;
  index.build(test::pointsOf(cloud), nullptr, {});
  Neighborhoods out;
  index.nearestKAll(k + 1, out);
  return out;
}

OrientationResult emptyResult(std::size_t n) {
  OrientationResult result;
  result.point_signs.assign(n, 0);
  result.point_confidences.assign(n, 0.F);
  result.point_components.assign(n, -1);
  return result;
}

std::size_t countWrong(const LabelledCloud& cloud, const std::vector<float>& normals,
                       const OrientationResult& result) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float agree = test::dot3(&normals[4 * i], &cloud.normals[4 * i]);
    if (static_cast<float>(result.point_signs[i]) * agree <= 0.F) ++wrong;
  }
  return wrong;
}

// From one face's points to a whole cube, across its edges.
TEST(Completion, SpreadsFromWhatIsOriented) {
  const LabelledCloud cloud = test::sample("cube", test::cube(), 6000, 21);
  const std::vector<float> normals = test::scrambledNormals(cloud, 22);
  OrientationResult result = emptyResult(cloud.size());
  result.components.resize(1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.face[i] != 0) continue;
    result.point_signs[i] =
        test::dot3(&normals[4 * i], &cloud.normals[4 * i]) > 0 ? std::int8_t{1} : std::int8_t{-1};
    result.point_components[i] = 0;
  }
  completeOrientation(test::pointsOf(cloud), {normals.data(), 4, cloud.size()},
                      neighborsOf(cloud, 12), result);
  EXPECT_LE(countWrong(cloud, normals, result), 6U);  // some at the very edges
  EXPECT_EQ(result.components.size(), 1U);
}

TEST(Completion, StartsComponentsOfItsOwnAndLeavesPointsWithoutNormal) {
  const LabelledCloud cloud =
      test::sample("two", {test::sphere({0, 0, 0}, 1), test::sphere({5, 0, 0}, 1)}, 3000, 23);
  std::vector<float> normals = test::scrambledNormals(cloud, 24);
  for (std::size_t i = 0; i < 100; ++i) normals[4 * i] = std::numeric_limits<float>::quiet_NaN();
  OrientationResult result = emptyResult(cloud.size());
  completeOrientation(test::pointsOf(cloud), {normals.data(), 4, cloud.size()},
                      neighborsOf(cloud, 12), result);
  EXPECT_EQ(result.components.size(), 2U);
  std::vector<int> balance(2, 0);
  std::vector<int> points(2, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i < 100) {
      EXPECT_EQ(result.point_signs[i], 0);
      EXPECT_EQ(result.point_components[i], -1);
      continue;
    }
    const auto face = static_cast<std::size_t>(cloud.face[i]);
    const float agree = test::dot3(&normals[4 * i], &cloud.normals[4 * i]);
    balance[face] += agree * static_cast<float>(result.point_signs[i]) > 0 ? 1 : -1;
    ++points[face];
  }
  EXPECT_EQ(std::abs(balance[0]), points[0]);
  EXPECT_EQ(std::abs(balance[1]), points[1]);
}

// The neighbour relation is made symmetric: a far point that nobody names is reached all the same,
// and one that is only named by others as well.
TEST(Completion, ReachesPointsThatNameNobodyOriented) {
  std::vector<float> xyz;
  std::vector<float> normals;
  for (int i = 0; i < 3; ++i) {
    xyz.insert(xyz.end(), {static_cast<float>(i), 0.F, 0.F, 0.F});
    normals.insert(normals.end(), {0.F, 0.F, i == 1 ? -1.F : 1.F, 0.F});
  }
  Neighborhoods table;
  table.reset(3, 2, false);
  const auto set = [&](std::size_t row, pcl::index_t neighbor) {
    table.mutableIndices(row)[0] = static_cast<pcl::index_t>(row);
    table.mutableIndices(row)[1] = neighbor;
    table.setCount(row, 2);
  };
  set(0, 1);
  set(1, 2);  // names 2, not 0
  set(2, 1);
  OrientationResult result = emptyResult(3);
  result.components.resize(1);
  result.point_signs[0] = 1;
  result.point_components[0] = 0;
  completeOrientation({xyz.data(), 4, 3}, {normals.data(), 4, 3}, table, result);
  EXPECT_EQ(result.point_signs, (std::vector<std::int8_t>{1, -1, 1}));
  EXPECT_EQ(result.point_components, (std::vector<std::int32_t>{0, 0, 0}));
}

TEST(PointTree, OrientsASmoothClosedSurface) {
  const LabelledCloud cloud = test::sample("torus", {test::torus(1, 0.4)}, 5000, 25);
  const std::vector<float> normals = test::scrambledNormals(cloud, 26);
  const OrientationResult result = orientByPointTree(
      test::pointsOf(cloud), {normals.data(), 4, cloud.size()}, neighborsOf(cloud, 10));
  EXPECT_EQ(countWrong(cloud, normals, result), 0U);
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_EQ(result.components[0].points, cloud.size());
}

// What the paper holds against it: with true normals at a sharp edge, it does not get across.
TEST(PointTree, FailsAtSharpEdges) {
  const LabelledCloud cloud = test::sample("bracket", test::bracket(), 6000, 27);
  const std::vector<float> normals = test::scrambledNormals(cloud, 28);
  const OrientationResult result = orientByPointTree(
      test::pointsOf(cloud), {normals.data(), 4, cloud.size()}, neighborsOf(cloud, 12));
  EXPECT_GT(countWrong(cloud, normals, result), cloud.size() / 20);
}

}  // namespace
}  // namespace segorient
