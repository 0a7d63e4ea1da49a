// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/common/neighborhoods.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "common/bulk_bounds.h"
#include "common/compact_cloud.h"

namespace segorient::test {
namespace {

using Place = std::array<float, 3>;

/// Random places, each third of them twice, with rows that are not finite among them.
std::vector<float> untidyCloud(std::size_t rows, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-1.F, 1.F);
  std::vector<float> xyz;
  for (std::size_t i = 0; i < rows; ++i) {
    if (i % 3 == 2) {
      const std::size_t earlier = random() % i;
      for (std::size_t a = 0; a < 3; ++a) xyz.push_back(xyz[3 * earlier + a]);
      continue;
    }
    for (std::size_t a = 0; a < 3; ++a) xyz.push_back(coordinate(random));
    if (i % 50 == 0) xyz.back() = std::numeric_limits<float>::quiet_NaN();
    if (i % 70 == 0) xyz.back() = -std::numeric_limits<float>::infinity();
  }
  return xyz;
}

PointView viewOf(const std::vector<float>& xyz) {
  return {xyz.data(), 3, xyz.size() / 3};
}

Place placeOf(const float* p) {
  return {p[0], p[1], p[2]};
}

// A part of a cloud has the order that it has in the cloud, if it is told where that is.
TEST(CompactCloud, APartHasTheOrderOfTheWhole) {
  const std::vector<float> xyz = untidyCloud(5000, 7);
  const PointView rows = viewOf(xyz);
  const CompactCloud whole = compactCloud(rows);
  Bounds frame;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const float* p = whole.view()[i];
    frame.add({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  std::vector<pcl::index_t> part;  // all in a corner
  for (std::size_t row = 0; row < rows.size; ++row) {
    if (rows[row][0] < 0.3F && rows[row][1] > -0.2F) part.push_back(static_cast<pcl::index_t>(row));
  }
  std::vector<Place> expected;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const float* p = whole.view()[i];
    if (p[0] < 0.3F && p[1] > -0.2F) expected.push_back(placeOf(p));
  }
  for (const int threads : {1, 3}) {
    const CompactCloud cloud = compactCloud(rows, &part, threads, &frame);
    ASSERT_EQ(cloud.size(), expected.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_EQ(placeOf(cloud.view()[i]), expected[i]);
    }
    // By itself it has another one, or the test says nothing.
    const CompactCloud alone = compactCloud(rows, &part, threads);
    bool same = true;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      same = same && placeOf(alone.view()[i]) == expected[i];
    }
    EXPECT_FALSE(same);
  }
}

TEST(CompactCloud, HasEachPlaceOnceAndItsFirstRow) {
  const std::vector<float> xyz = untidyCloud(5000, 1);
  const PointView rows = viewOf(xyz);
  std::map<Place, pcl::index_t> first;
  for (std::size_t row = 0; row < rows.size; ++row) {
    if (isFinite(rows[row])) first.emplace(placeOf(rows[row]), static_cast<pcl::index_t>(row));
  }
  for (const int threads : {1, 2, 5}) {
    const CompactCloud cloud = compactCloud(rows, nullptr, threads);
    ASSERT_EQ(cloud.size(), first.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_EQ(cloud.source[i], first.at(placeOf(cloud.view()[i])));
      EXPECT_EQ(cloud.xyz[4 * i + 3], 0.F);
    }
    for (std::size_t row = 0; row < rows.size; ++row) {
      const pcl::index_t point = cloud.row_of[row];
      ASSERT_EQ(point >= 0, isFinite(rows[row]));
      if (point < 0) continue;
      EXPECT_EQ(placeOf(cloud.view()[static_cast<std::size_t>(point)]), placeOf(rows[row]));
    }
  }
}

TEST(CompactCloud, OrderDependsNeitherOnThreadsNorOnTheInput) {
  const std::vector<float> xyz = untidyCloud(4000, 2);
  std::vector<std::size_t> order(xyz.size() / 3);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::vector<float> shuffled;
  for (const std::size_t row : order) {
    shuffled.insert(shuffled.end(), {xyz[3 * row], xyz[3 * row + 1], xyz[3 * row + 2]});
  }
  const CompactCloud one = compactCloud(viewOf(xyz), nullptr, 1);
  for (const int threads : {2, 3, 8}) {
    const CompactCloud more = compactCloud(viewOf(xyz), nullptr, threads);
    EXPECT_EQ(more.xyz, one.xyz);
    EXPECT_EQ(more.source, one.source);
    EXPECT_EQ(more.row_of, one.row_of);
    EXPECT_EQ(compactCloud(viewOf(shuffled), nullptr, threads).xyz, one.xyz);
  }
}

TEST(CompactCloud, OfNothingAndOfOnePoint) {
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  for (const int threads : {1, 4}) {
    EXPECT_EQ(compactCloud({}, nullptr, threads).size(), 0U);
    const std::vector<float> lost(9, nothing);
    EXPECT_EQ(compactCloud(viewOf(lost), nullptr, threads).size(), 0U);
    const std::vector<float> same{1.F, 2.F, 3.F, 1.F, 2.F, 3.F};
    const CompactCloud cloud = compactCloud(viewOf(same), nullptr, threads);
    ASSERT_EQ(cloud.size(), 1U);
    EXPECT_EQ(cloud.row_of, (std::vector<pcl::index_t>{0, 0}));
  }
}

TEST(Neighborhoods, FullRowsMayBecomeShorter) {
  Neighborhoods table;
  table.resetFull(3, 5, 4, false);
  EXPECT_EQ(table.count(0), 4);
  EXPECT_EQ(table.count(2), 4);
  EXPECT_EQ(table.k(), 5);
  table.setCount(1, 2);
  EXPECT_EQ(table.count(0), 4);
  EXPECT_EQ(table.count(1), 2);
  table.reset(3, 5, false);
  EXPECT_EQ(table.count(2), 0);
}

}  // namespace
}  // namespace segorient::test
