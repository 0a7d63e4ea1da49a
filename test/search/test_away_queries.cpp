// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Queries away from the points: from everywhere between them and ten diagonals outside.
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cmath>
#include <random>
#include <thread>

#include "brute_force.h"
#include "search/shared_block.h"
#include "search_clouds.h"

namespace segorient::test {
namespace {

using search::MedianHashIndex;

std::vector<Neighbor> nearest(const MedianHashIndex& index, const std::array<float, 3>& query,
                              std::size_t k) {
  pcl::Indices indices(k);
  std::vector<float> distances(k);
  const int found =
      index.nearestK(query.data(), static_cast<int>(k), indices.data(), distances.data());
  std::vector<Neighbor> result;
  for (std::size_t i = 0; i < static_cast<std::size_t>(found); ++i) {
    result.push_back({distances[i], indices[i]});
  }
  return result;
}

/// From points of the cloud outwards, by so many diagonals of its bounding box.
std::vector<std::array<float, 3>> queriesAway(const SearchCloud& cloud, double diagonals,
                                              std::size_t count) {
  std::array<double, 3> low{1e300, 1e300, 1e300};
  std::array<double, 3> high{-1e300, -1e300, -1e300};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!isFinite(cloud.view()[i])) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], static_cast<double>(cloud.view()[i][a]));
      high[a] = std::max(high[a], static_cast<double>(cloud.view()[i][a]));
    }
  }
  const double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  std::mt19937 random(static_cast<unsigned>(1000.0 * diagonals));
  std::normal_distribution<double> g(0.0, 1.0);
  std::vector<std::array<float, 3>> queries;
  for (std::size_t i = 0; queries.size() < count && i < cloud.size(); ++i) {
    const float* p = cloud.view()[i * 37 % cloud.size()];
    if (!isFinite(p)) continue;
    const std::array<double, 3> to{g(random), g(random), g(random)};
    const double step = diagonals * diagonal / std::hypot(to[0], to[1], to[2]);
    std::array<float, 3> q{};
    for (std::size_t a = 0; a < 3; ++a) {
      constexpr double kMost = std::numeric_limits<float>::max();
      q[a] =
          static_cast<float>(std::clamp(static_cast<double>(p[a]) + step * to[a], -kMost, kMost));
    }
    queries.push_back(q);
  }
  return queries;
}

class AwayFromCloud : public testing::TestWithParam<SearchCloud> {};

// Small regions, so that there are boxes above boxes both in regions and above them.
TEST_P(AwayFromCloud, NearestKEqualsBruteForce) {
  const SearchCloud& cloud = GetParam();
  for (const std::size_t region : {40U, 600U, 4096U}) {
    MedianHashIndex index;
    MedianHashIndex::Options options;
    options.region_size = region;
    index.build(cloud.view(), nullptr, options);
    for (const double diagonals : {0.0, 0.01, 0.3, 1.0, 10.0}) {
      // Many in turn: what was learnt from those before must not show.
      for (const auto& query : queriesAway(cloud, diagonals, 12)) {
        auto expected = bruteForce(cloud.view(), query.data());
        for (const std::size_t k : {300U, 10U, 1U}) {
          expected.resize(std::min<std::size_t>(k, expected.size()));
          EXPECT_EQ(nearest(index, query, k), expected)
              << k << " nearest from " << diagonals << " diagonals, regions of " << region;
        }
      }
    }
  }
}

TEST_P(AwayFromCloud, ApproximateKeepsItsPromise) {
  const SearchCloud& cloud = GetParam();
  MedianHashIndex index;
  MedianHashIndex::Options options;
  options.region_size = 100;
  options.epsilon = 0.3F;
  index.build(cloud.view(), nullptr, options);
  for (const double diagonals : {0.1, 3.0}) {
    for (const auto& query : queriesAway(cloud, diagonals, 10)) {
      const auto exact = bruteForce(cloud.view(), query.data());
      const auto found = nearest(index, query, 10);
      ASSERT_EQ(found.size(), std::min<std::size_t>(10, exact.size()));
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_LE(std::sqrt(static_cast<double>(found[i].distance)),
                  1.300001 * std::sqrt(static_cast<double>(exact[i].distance)));
      }
      EXPECT_EQ(nearest(index, query, 10), found) << "asked again";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, AwayFromCloud, testing::ValuesIn(searchClouds(1500)));

// The boxes are made by the first queries that need them, whichever threads these come from.
TEST(Away, FirstQueriesFromSeveralThreads) {
  const SearchCloud cloud = searchClouds(4000)[1];
  const auto queries = queriesAway(cloud, 0.5, 40);
  std::vector<std::vector<Neighbor>> expected;
  for (const auto& q : queries) {
    expected.push_back(bruteForce(cloud.view(), q.data()));
    expected.back().resize(5);
  }
  for (int attempt = 0; attempt < 5; ++attempt) {
    MedianHashIndex index;
    MedianHashIndex::Options options;
    options.region_size = 200;
    index.build(cloud.view(), nullptr, options);
    const std::size_t before = index.memory();
    std::vector<std::thread> threads;
    std::array<int, 4> wrong{};
    for (std::size_t t = 0; t < wrong.size(); ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t i = 0; i < queries.size(); ++i) {
          wrong[t] += nearest(index, queries[i], 5) == expected[i] ? 0 : 1;
        }
      });
    }
    for (auto& thread : threads) thread.join();
    for (const int count : wrong) EXPECT_EQ(count, 0);
    EXPECT_GT(index.memory(), before) << "boxes are memory";
    EXPECT_LT(index.memory(), before + 2 * 16 * cloud.size() + 40000);
  }
}

// Two structures in turn, as in reciprocal correspondences.
TEST(Away, TwoStructuresInTurn) {
  const std::vector<SearchCloud> clouds = searchClouds(2000);
  const SearchCloud& a = clouds[1];
  const SearchCloud& b = clouds[0];
  MedianHashIndex index_a;
  MedianHashIndex index_b;
  index_a.build(a.view(), nullptr, {});
  index_b.build(b.view(), nullptr, {});
  for (const auto& query : queriesAway(a, 0.02, 100)) {
    for (const auto* pair : {&a, &b}) {
      auto expected = bruteForce(pair->view(), query.data());
      expected.resize(1);
      EXPECT_EQ(nearest(pair == &a ? index_a : index_b, query, 1), expected);
    }
  }
}

// As of a depth camera that writes 0,0,0 where it saw nothing: of many points in one place the
// smallest indices count, whether regions are full of them or hold some.
TEST(Away, ManyPointsInOnePlace) {
  for (const std::size_t zeros : {40U, 900U, 2500U}) {
    SearchCloud cloud = searchClouds(3000)[1];
    for (std::size_t i = 0; i < zeros; ++i) {
      for (std::size_t a = 0; a < 3; ++a) cloud.xyz[4 * (i * 7 % 3000) + a] = 0.F;
    }
    for (const std::size_t region : {100U, 1000U, 4096U}) {
      MedianHashIndex index;
      MedianHashIndex::Options options;
      options.region_size = region;
      index.build(cloud.view(), nullptr, options);
      for (const double diagonals : {0.0, 0.003, 0.1, 3.0}) {
        for (const auto& query : queriesAway(cloud, diagonals, 40)) {
          auto expected = bruteForce(cloud.view(), query.data());
          for (const std::size_t k : {100U, 33U, 32U, 10U, 1U}) {
            expected.resize(k);
            ASSERT_EQ(nearest(index, query, k), expected)
                << k << " nearest from " << diagonals << " diagonals, " << zeros << " zeros";
          }
        }
      }
    }
  }
}

TEST(Away, EachStructureHasItsOwnMemory) {
  search::RecentPair pair;
  search::Recent& first = pair.of(1);
  EXPECT_EQ(&pair.of(1), &first);
  first.away.was(true);
  search::Recent& second = pair.of(2);
  EXPECT_NE(&second, &first);
  EXPECT_EQ(&pair.of(2), &second) << "also before its first query is done";
  EXPECT_EQ(&pair.of(1), &first);
  EXPECT_TRUE(first.away.isLikely()) << "as it was left";
  second.away.was(true);
  EXPECT_EQ(&pair.of(3), &second) << "the one that was not asked last";
  EXPECT_FALSE(second.away.isLikely());
  EXPECT_EQ(second.last.k, 0U);
  EXPECT_EQ(&pair.of(1), &first);
}

}  // namespace
}  // namespace segorient::test
