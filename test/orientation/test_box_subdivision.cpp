// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "orientation/paper/box_subdivision.h"
#include "orientation/paper/extremal_points.h"
#include "oriented_shapes.h"

namespace segorient {
namespace {

using test::LabelledCloud;

std::vector<pcl::index_t> allRows(std::size_t n) {
  std::vector<pcl::index_t> rows(n);
  std::iota(rows.begin(), rows.end(), pcl::index_t{0});
  return rows;
}

double volume(const BoxSubdivision::Box& box) {
  double v = 1;
  for (std::size_t a = 0; a < 3; ++a)
    v *= static_cast<double>(box.high[a] - box.low[a]) / (1 << 20);
  return v;
}

TEST(BoxSubdivision, LeavesHoldAllPointsOnceAndFillTheBox) {
  const LabelledCloud cloud = test::sample("torus", {test::torus(1, 0.4)}, 5000, 1);
  const BoxSubdivision space(test::pointsOf(cloud), allRows(cloud.size()), 50);
  double filled = 0;
  std::size_t held = 0;
  for (const BoxSubdivision::Box& box : space.boxes()) {
    if (box.children != 0) continue;
    EXPECT_LE(box.size, 50U);
    filled += volume(box);
    held += box.size;
  }
  EXPECT_EQ(held, cloud.size());
  EXPECT_NEAR(filled, 1.0, 1e-9);
  std::vector<pcl::index_t> rows = space.points();
  std::sort(rows.begin(), rows.end());
  EXPECT_EQ(rows, allRows(cloud.size()));
}

TEST(BoxSubdivision, EatsTheOutsideAndNotTheInside) {
  const LabelledCloud cloud = test::sample("sphere", {test::sphere({0, 0, 0}, 1)}, 20000, 2);
  const BoxSubdivision space(test::pointsOf(cloud), allRows(cloud.size()), 60);
  std::size_t outside = 0;
  std::size_t inside = 0;
  for (const BoxSubdivision::Box& box : space.boxes()) {
    if (box.children != 0 || box.size != 0) continue;
    double squared = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double middle = (static_cast<double>(box.low[a]) + box.high[a]) / (1 << 20) - 1;
      squared += middle * middle;
    }
    EXPECT_EQ(box.removed, squared > 1);
    ++(squared > 1 ? outside : inside);
  }
  EXPECT_GT(outside, 50U);
  EXPECT_GT(inside, 50U);
}

TEST(BoxSubdivision, CopesWithFlatLineAndRepeatedPoints) {
  std::vector<float> xyz;
  for (int i = 0; i < 300; ++i) xyz.insert(xyz.end(), {static_cast<float>(i % 30), 0.F, 0.F, 0.F});
  const PointView line{xyz.data(), 4, 300};
  const BoxSubdivision space(line, allRows(300), 5);
  for (const BoxSubdivision::Box& box : space.boxes()) {
    if (box.children != 0) continue;
    EXPECT_TRUE(space.isFree(box, {1, true}));
    EXPECT_TRUE(space.isFree(box, {2, false}));
    EXPECT_LE(box.size, 10U);  // ten points in one place cannot be parted
  }
  EXPECT_TRUE(BoxSubdivision(line, {}, 5).boxes().empty());
}

TEST(ExtremalPoints, PointOutOfAClosedSolid) {
  const LabelledCloud cloud = test::sample("holed", test::holedSolid(), 12000, 3);
  const std::vector<ExtremalPoint> found =
      findExtremalPoints(test::pointsOf(cloud), test::normalsOf(cloud), allRows(cloud.size()), 120);
  std::size_t voting = 0;
  std::size_t wrong = 0;
  for (const ExtremalPoint& point : found) {
    if (point.angle > 0.6F) continue;
    ++voting;
    if (point.sign < 0) ++wrong;
  }
  EXPECT_GT(voting, 100U);
  EXPECT_LE(wrong, voting / 20);
}

// The paper: "this procedure works only for closed objects".
TEST(ExtremalPoints, AreOfTwoMindsInAnOpenBowl) {
  const LabelledCloud cloud = test::sample("bowl", {test::bowl({0, 0, 0}, 1)}, 8000, 4);
  Segmentation one;
  one.labels.assign(cloud.size(), 0);
  one.signs.assign(cloud.size(), 1);
  one.segments.resize(1);
  const auto found =
      findExtremalPoints(test::pointsOf(cloud), test::normalsOf(cloud), allRows(cloud.size()), 120);
  const auto evidence = gatherExtremalEvidence(found, one, 0.6F);
  ASSERT_EQ(evidence.size(), 1U);
  EXPECT_GT(evidence[0].votes, 20);
  EXPECT_LT(evidence[0].agreement, 0.5F);
}

TEST(ExtremalPoints, SmallestAngleDecides) {
  Segmentation two;
  two.labels = {0, 0, 1, -1};
  two.signs = {1, -1, 1, 1};
  two.segments.resize(2);
  const std::vector<ExtremalPoint> found{{0, 1, 0.5F}, {1, 1, 0.1F}, {2, -1, 0.7F}, {3, 1, 0.0F}};
  const auto evidence = gatherExtremalEvidence(found, two, 0.6F);
  EXPECT_EQ(evidence[0].sign, -1);
  EXPECT_FLOAT_EQ(evidence[0].angle, 0.1F);
  EXPECT_EQ(evidence[0].votes, 2);
  EXPECT_NEAR(evidence[0].agreement,
              (std::cos(0.1F) - std::cos(0.5F)) / (std::cos(0.1F) + std::cos(0.5F)), 1e-5);
  EXPECT_EQ(evidence[1].sign, 0);  // beyond gamma
  EXPECT_FLOAT_EQ(evidence[1].angle, 0.6F);
}

}  // namespace
}  // namespace segorient
