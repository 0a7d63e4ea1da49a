// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "brute_force.h"
#include "search_clouds.h"

namespace segorient::test {
namespace {

using search::MedianHashIndex;

class AllPoints : public testing::TestWithParam<SearchCloud> {};

TEST_P(AllPoints, EqualsBruteForce) {
  const SearchCloud& cloud = GetParam();
  for (const std::size_t region_size : {std::size_t{40}, std::size_t{2048}}) {
    MedianHashIndex::Options options;
    options.region_size = region_size;
    MedianHashIndex index;
    index.build(cloud.view(), nullptr, options);
    for (const int k : {1, 5, 18, 33, 70}) {
      Neighborhoods table;
      index.nearestKAll(k, table);
      ASSERT_EQ(table.size(), cloud.size());
      for (std::size_t i = 0; i < cloud.size(); i += 23) {
        std::vector<Neighbor> expected;
        if (isFinite(cloud.view()[i])) {
          expected = bruteForceRow(cloud.view(), static_cast<pcl::index_t>(i),
                                   static_cast<std::size_t>(k));
        }
        ASSERT_EQ(row(table, i), expected) << "row " << i << ", k " << k;
      }
    }
  }
}

TEST_P(AllPoints, SubsetOfIndices) {
  const SearchCloud& cloud = GetParam();
  const std::vector<pcl::index_t> indices = everyOtherIndex(cloud);
  MedianHashIndex index;
  index.build(cloud.view(), &indices, {});
  Neighborhoods table;
  index.nearestKAll(9, table);
  ASSERT_EQ(table.size(), indices.size());
  for (std::size_t i = 0; i < indices.size(); i += i < 10 ? 1 : 13) {
    const auto expected = cloud.has(indices[i])
                              ? bruteForceRow(cloud.view(), indices[i], 9, &indices)
                              : std::vector<Neighbor>{};
    ASSERT_EQ(row(table, i), expected) << "row " << i;
  }
}

TEST_P(AllPoints, SameForAnyNumberOfThreadsAndWithoutDistances) {
  const SearchCloud& cloud = GetParam();
  MedianHashIndex::Options options;
  options.region_size = 100;
  options.threads = 1;
  MedianHashIndex one;
  one.build(cloud.view(), nullptr, options);
  options.threads = 3;
  MedianHashIndex three;
  three.build(cloud.view(), nullptr, options);
  Neighborhoods with;
  one.nearestKAll(12, with);
  Neighborhoods without;
  three.nearestKAll(12, without, false);
  ASSERT_FALSE(without.hasDistances());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_EQ(with.count(i), without.count(i));
    const auto count = with.count(i);
    ASSERT_TRUE(std::equal(with.indices(i), with.indices(i) + count, without.indices(i)));
  }
}

TEST_P(AllPoints, RegionByRegionTheSameRows) {
  const SearchCloud& cloud = GetParam();
  const std::vector<pcl::index_t> indices = everyOtherIndex(cloud);
  for (const int threads : {1, 3}) {
    for (const auto* of : {static_cast<const std::vector<pcl::index_t>*>(nullptr), &indices}) {
      MedianHashIndex::Options options;
      options.region_size = 100;
      options.threads = threads;
      MedianHashIndex index;
      index.build(cloud.view(), of, options);
      Neighborhoods all;
      index.nearestKAll(33, all, false);
      std::mutex mutex;
      std::size_t visited = 0;
      index.nearestKByRegion(
          33, [&](const std::vector<pcl::index_t>& rows, const Neighborhoods& table) {
            const std::lock_guard<std::mutex> lock(mutex);
            visited += rows.size();
            ASSERT_EQ(table.size(), rows.size());
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const auto row = static_cast<std::size_t>(rows[i]);
              const int count = all.count(row);
              ASSERT_EQ(table.count(i), count);
              ASSERT_TRUE(std::equal(all.indices(row), all.indices(row) + count, table.indices(i)))
                  << "row " << row;
            }
          });
      EXPECT_EQ(visited, index.size());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, AllPoints, testing::ValuesIn(searchClouds(1000)));

TEST(AllPoints, ManyRegionsAgreeWithSingleQueries) {
  for (const SearchCloud& cloud : searchClouds(12000)) {
    if (cloud.name == "one place" || cloud.name == "overflowing squares" ||
        cloud.name == "largest floats" || cloud.name == "tiny") {
      continue;  // every distance is equal: quadratic by nature, and covered above
    }
    MedianHashIndex index;
    index.build(cloud.view(), nullptr, {});
    Neighborhoods table;
    index.nearestKAll(19, table);
    std::vector<pcl::index_t> indices(19);
    std::vector<float> distances(19);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float* query = cloud.view()[i];
      if (!isFinite(query)) continue;
      ASSERT_EQ(index.nearestK(query, 19, indices.data(), distances.data()), table.count(i));
      const float* row_distances = table.sqrDistances(i);
      ASSERT_TRUE(std::equal(distances.begin(), distances.end(), row_distances))
          << cloud.name << ", row " << i;
    }
  }
}

// With regions as large as they usually are, and one for all points.
TEST(AllPoints, LargeRegionsEqualBruteForce) {
  for (const SearchCloud& cloud : searchClouds(9000)) {
    for (const std::size_t region_size : {std::size_t{4096}, std::size_t{32768}}) {
      MedianHashIndex::Options options;
      options.region_size = region_size;
      MedianHashIndex index;
      index.build(cloud.view(), nullptr, options);
      Neighborhoods table;
      index.nearestKAll(15, table);
      for (std::size_t i = 0; i < cloud.size(); i += 307) {
        std::vector<Neighbor> expected;
        if (isFinite(cloud.view()[i])) {
          expected = bruteForceRow(cloud.view(), static_cast<pcl::index_t>(i), 15);
        }
        ASSERT_EQ(row(table, i), expected) << cloud.name << ", row " << i;
      }
    }
  }
}

TEST(AllPoints, KLargerThanTheCloud) {
  const SearchCloud cloud = searchClouds(7).front();
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, {});
  Neighborhoods table;
  index.nearestKAll(50, table);
  EXPECT_EQ(table.k(), 50);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(row(table, i), bruteForceRow(cloud.view(), static_cast<pcl::index_t>(i), 50));
  }
}

// So many are searched for one by one.
TEST(AllPoints, RegionByRegionManyNeighbors) {
  for (const SearchCloud& cloud : searchClouds(900)) {
    MedianHashIndex::Options options;
    options.region_size = 100;
    MedianHashIndex index;
    index.build(cloud.view(), nullptr, options);
    Neighborhoods all;
    index.nearestKAll(300, all, false);
    index.nearestKByRegion(
        300, [&](const std::vector<pcl::index_t>& rows, const Neighborhoods& table) {
          for (std::size_t i = 0; i < rows.size(); i += 19) {
            const auto row = static_cast<std::size_t>(rows[i]);
            const int count = all.count(row);
            ASSERT_EQ(table.count(i), count);
            ASSERT_TRUE(std::equal(all.indices(row), all.indices(row) + count, table.indices(i)));
          }
        });
  }
}

TEST(AllPoints, RegionByRegionOfNothing) {
  MedianHashIndex index;
  const auto fail = [](const std::vector<pcl::index_t>&, const Neighborhoods&) { FAIL(); };
  index.nearestKByRegion(5, fail);
  const SearchCloud cloud = searchClouds(7).front();
  index.build(cloud.view(), nullptr, {});
  index.nearestKByRegion(0, fail);
  index.nearestKByRegion(-3, fail);
}

TEST(AllPoints, RegionByRegionPassesOnWhatIsThrown) {
  const SearchCloud cloud = searchClouds(7000).front();
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, {});
  EXPECT_THROW(index.nearestKByRegion(
                   5, [](const auto&, const auto&) { throw std::runtime_error("enough"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace segorient::test
