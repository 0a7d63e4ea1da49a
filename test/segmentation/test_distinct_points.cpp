// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "distinct_points.h"

namespace segorient::test {
namespace {

using segmentation::DistinctPoints;

void addAll(const std::vector<pcl::index_t>& points, DistinctPoints& distinct) {
  distinct.reserve(points.size());
  for (const pcl::index_t p : points) distinct.add(p, true);
}

// Whatever shares a slot, nothing is lost and nothing comes that was not there.
TEST(DistinctPoints, HoldsAllOfARound) {
  std::mt19937 random(3);
  DistinctPoints distinct;
  for (int round = 0; round < 200; ++round) {
    std::uniform_int_distribution<pcl::index_t> any(0, round % 2 == 0 ? 300 : 1000000);
    std::vector<pcl::index_t> points(1500);
    for (pcl::index_t& p : points) p = any(random);
    if (round > 0) distinct.restart();
    addAll(points, distinct);
    EXPECT_EQ(std::set<pcl::index_t>(distinct.begin(), distinct.end()),
              std::set<pcl::index_t>(points.begin(), points.end()));
  }
}

TEST(DistinctPoints, NeighborsInMemoryComeOnce) {
  DistinctPoints distinct;
  addAll({0, 0, 7, 1023, 7, 0, 500, 1023}, distinct);
  EXPECT_EQ(std::vector<pcl::index_t>(distinct.begin(), distinct.end()),
            (std::vector<pcl::index_t>{0, 7, 1023, 500}));
  distinct.restart();
  EXPECT_EQ(distinct.size(), 0U);
  addAll({7, 7}, distinct);
  ASSERT_EQ(distinct.size(), 1U);
  EXPECT_EQ(distinct[0], 7);
}

TEST(DistinctPoints, UnwantedOnesAreNotThere) {
  DistinctPoints distinct;
  distinct.reserve(3);
  distinct.add(4, false);
  distinct.add(4, true);
  distinct.add(4, false);
  ASSERT_EQ(distinct.size(), 1U);
  EXPECT_EQ(distinct[0], 4);
}

}  // namespace
}  // namespace segorient::test
