// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "brute_force.h"
#include "sanitized.h"
#include "search_clouds.h"

namespace segorient::test {
namespace {

using search::MedianHashIndex;

// What the table owes to point `self`: itself first, then all that is strictly nearer than the
// radius.
std::vector<Neighbor> expectedRow(const PointView& points, pcl::index_t self, double radius,
                                  unsigned int max_nn,
                                  const std::vector<pcl::index_t>* indices = nullptr) {
  const std::size_t rows = indices != nullptr ? indices->size() : points.size;
  std::vector<Neighbor> all = bruteForceRow(points, self, rows, indices);
  const auto limit = static_cast<float>(std::min(radius * radius, 1e300));
  const auto far = std::find_if(all.begin(), all.end(),
                                [&](const Neighbor& n) { return !(n.distance < limit); });
  all.erase(far, all.end());
  if (max_nn > 0 && all.size() > max_nn) all.resize(max_nn);
  return all;
}

// Radii with about 1, 20 and 150 results, and one with all.
std::vector<double> radii(const SearchCloud& cloud) {
  std::vector<double> result{1e25};
  std::size_t at = cloud.size() / 2;
  while (!isFinite(cloud.view()[at])) ++at;
  const auto all = bruteForce(cloud.view(), cloud.view()[at]);
  for (const std::size_t rank : {std::size_t{1}, std::size_t{20}, std::size_t{150}}) {
    result.push_back(std::sqrt(static_cast<double>(all[rank].distance)));
  }
  return result;
}

class RadiusAll : public testing::TestWithParam<SearchCloud> {};

TEST_P(RadiusAll, EqualsBruteForce) {
  const SearchCloud& cloud = GetParam();
  for (const std::size_t region_size : {std::size_t{40}, std::size_t{2048}}) {
    MedianHashIndex::Options options;
    options.region_size = region_size;
    MedianHashIndex index;
    index.build(cloud.view(), nullptr, options);
    for (const double radius : radii(cloud)) {
      for (const unsigned int max_nn : {0U, 3U}) {
        RadiusNeighborhoods table;
        index.radiusAll(radius, table, max_nn);
        ASSERT_EQ(table.size(), cloud.size());
        for (std::size_t i = 0; i < cloud.size(); i += 31) {
          std::vector<Neighbor> expected;
          if (isFinite(cloud.view()[i])) {
            expected = expectedRow(cloud.view(), static_cast<pcl::index_t>(i), radius, max_nn);
          }
          ASSERT_EQ(row(table, i), expected) << "row " << i << ", radius " << radius;
        }
      }
    }
  }
}

TEST_P(RadiusAll, SubsetOfIndices) {
  const SearchCloud& cloud = GetParam();
  const std::vector<pcl::index_t> indices = everyOtherIndex(cloud);
  MedianHashIndex index;
  index.build(cloud.view(), &indices, {});
  const double radius = radii(cloud)[2];
  RadiusNeighborhoods table;
  index.radiusAll(radius, table);
  ASSERT_EQ(table.size(), indices.size());
  for (std::size_t i = 0; i < indices.size(); i += i < 10 ? 1 : 13) {
    const auto expected = cloud.has(indices[i])
                              ? expectedRow(cloud.view(), indices[i], radius, 0, &indices)
                              : std::vector<Neighbor>{};
    ASSERT_EQ(row(table, i), expected) << "row " << i;
  }
}

TEST_P(RadiusAll, SameForAnyNumberOfThreadsAndInstructionSet) {
  const SearchCloud& cloud = GetParam();
  const double radius = std::max(radii(cloud)[2], 1e-15);  // 0 where all are in one place
  RadiusNeighborhoods first;
  for (const char* instruction_set : {"scalar", "sse2", "avx2", "avx512"}) {
    setenv("SEGORIENT_SIMD", instruction_set, 1);
    MedianHashIndex::Options options;
    options.region_size = 100;
    options.threads = 3;
    MedianHashIndex index;
    index.build(cloud.view(), nullptr, options);
    unsetenv("SEGORIENT_SIMD");
    RadiusNeighborhoods table;
    index.radiusAll(radius, table, 0, false);
    ASSERT_FALSE(table.hasDistances());
    EXPECT_EQ(table.sqrDistances(0), nullptr);
    index.setNumberOfThreads(1);
    RadiusNeighborhoods one;
    index.radiusAll(radius, one);
    if (first.size() == 0) first = one;
    ASSERT_GT(first.entries(), 0U);
    ASSERT_EQ(table.entries(), first.entries());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_EQ(row(one, i), row(first, i)) << "row " << i;
      ASSERT_EQ(table.count(i), first.count(i));
      ASSERT_TRUE(
          std::equal(table.indices(i), table.indices(i) + table.count(i), first.indices(i)));
    }
  }
}

// With regions as large as they usually are, and one for all points.
TEST(RadiusAllLargeRegions, EqualBruteForce) {
  for (const SearchCloud& cloud : searchClouds(9000)) {
    const double radius = radii(cloud)[2];
    for (const std::size_t region_size : {std::size_t{4096}, std::size_t{32768}}) {
      MedianHashIndex::Options options;
      options.region_size = region_size;
      MedianHashIndex index;
      index.build(cloud.view(), nullptr, options);
      RadiusNeighborhoods table;
      index.radiusAll(radius, table, 200);
      for (std::size_t i = 0; i < cloud.size(); i += 307) {
        std::vector<Neighbor> expected;
        if (isFinite(cloud.view()[i])) {
          expected = expectedRow(cloud.view(), static_cast<pcl::index_t>(i), radius, 200);
        }
        ASSERT_EQ(row(table, i), expected) << cloud.name << ", row " << i;
      }
    }
  }
}

// Checks some rows of the table, and single queries, against brute force.
void expectBruteForce(const std::vector<std::array<float, 3>>& points, double radius,
                      unsigned int max_nn, std::size_t step) {
  const PointView view{points.front().data(), 3, points.size()};
  std::vector<decltype(expectedRow(view, 0, radius, max_nn))> all_expected;
  for (std::size_t i = 0; i < points.size(); i += step) {
    all_expected.push_back(expectedRow(view, static_cast<pcl::index_t>(i), radius, max_nn));
  }
  for (const char* instruction_set : {"scalar", "sse2", "avx2", "avx512"}) {
    setenv("SEGORIENT_SIMD", instruction_set, 1);
    MedianHashIndex index;
    index.build(view, nullptr, {});
    unsetenv("SEGORIENT_SIMD");
    RadiusNeighborhoods table;
    index.radiusAll(radius, table, max_nn);
    std::vector<pcl::index_t> indices;
    std::vector<float> distances;
    for (std::size_t i = 0; i < points.size(); i += step) {
      const auto& expected = all_expected[i / step];
      ASSERT_EQ(row(table, i), expected) << instruction_set << ", row " << i;
      index.radius(view[i], radius, indices, distances, max_nn, true);
      const bool same =
          std::equal(distances.begin(), distances.end(), expected.begin(), expected.end(),
                     [](float distance, const auto& e) { return distance == e.distance; });
      ASSERT_TRUE(same) << instruction_set << ", row " << i;
    }
  }
}

// A group of 31 points, of which the last but one fills its half of the room for candidates to the
// last entry that may be taken.
TEST(RadiusAllRoom, FullToTheLastEntry) {
  std::mt19937 rng(41);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  for (const int behind : {11, 12, 13, 14, 18, 22}) {
    std::vector<std::array<float, 3>> points;
    for (int i = 0; i < 31; ++i) points.push_back({1e-4F * static_cast<float>(i), 0.F, 0.F});
    for (int i = 0; i < 974; ++i) {
      points.push_back({1e-3F * unit(rng), -0.501F + 2e-3F * unit(rng), 1e-3F * unit(rng)});
    }
    // Near enough for the last ones of the group only.
    for (int i = 0; i < behind; ++i) {
      points.push_back({1.00295F, 1e-6F * static_cast<float>(i), 0.F});
    }
    expectBruteForce(points, 1.0, 0, 1);
  }
}

// As many candidates as are sorted in one go, more, and more than a group shares; all in one place
// or around it.
TEST(RadiusAllRoom, CrowdedPlaces) {
  std::mt19937 rng(42);
  std::uniform_real_distribution<float> unit(-0.1F, 0.1F);
  for (const std::size_t size : {40U, 64U, 65U, 1000U, 1024U, 1025U, 9000U}) {
    for (const bool in_one_place : {true, false}) {
      std::vector<std::array<float, 3>> points;
      for (std::size_t i = 0; i < size; ++i) {
        points.push_back({3.F, 3.F, 3.F});
        if (!in_one_place) {
          for (float& x : points.back()) x += unit(rng);
        }
      }
      for (int i = 0; i < 50; ++i) points.push_back({static_cast<float>(i), 0.F, 0.F});
      for (const unsigned int max_nn : {0U, 3U, 70U}) {
        if (size > 2000 && max_nn == 0) continue;  // a row of all for each: gigabytes
        expectBruteForce(points, 1.0, max_nn, size < 1000 ? 1 : size / 10);
      }
    }
  }
}

// Rows are written over those of the search before.
TEST_P(RadiusAll, TablesMayBeFilledAgain) {
  const SearchCloud& cloud = GetParam();
  MedianHashIndex::Options options;
  options.region_size = 100;
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, options);
  RadiusNeighborhoods table;
  for (const double radius : radii(cloud)) {
    for (const bool with_distances : {true, false, true}) {
      RadiusNeighborhoods fresh;
      index.radiusAll(radius, fresh, 0);
      index.radiusAll(radius, table, 0, with_distances);
      ASSERT_EQ(table.hasDistances(), with_distances);
      ASSERT_EQ(table.entries(), fresh.entries());
      std::size_t entries = 0;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        ASSERT_EQ(table.count(i), fresh.count(i));
        entries += table.count(i);
        ASSERT_TRUE(
            std::equal(table.indices(i), table.indices(i) + table.count(i), fresh.indices(i)));
        if (with_distances) {
          ASSERT_EQ(row(table, i), row(fresh, i));
        }
      }
      ASSERT_EQ(entries, table.entries());
      EXPECT_GE(table.memory(), entries * (with_distances ? 8 : 4));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, RadiusAll, testing::ValuesIn(searchClouds(1000)));

template <typename Flag, typename = void>
struct TakesForMaxNn : std::false_type {};
template <typename Flag>
struct TakesForMaxNn<Flag, std::void_t<decltype(std::declval<const MedianHashIndex&>().radiusAll(
                               1.0, std::declval<RadiusNeighborhoods&>(), std::declval<Flag>()))>>
    : std::true_type {};
static_assert(TakesForMaxNn<unsigned int>::value && TakesForMaxNn<int>::value);
static_assert(!TakesForMaxNn<bool>::value, "whoever writes that means with_distances");

#ifndef SEGORIENT_MEMORY_SANITIZED
// Everything is near everything, which is more than there is memory for: an error that the caller
// can catch, from any thread, not an end of the program.
TEST(RadiusAllLargeRegions, MoreThanMemoryHolds) {
  const auto lacks_memory = [] {
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = rlim_t{1} << 30U;
    setrlimit(RLIMIT_AS, &limit);
    const SearchCloud cloud = searchClouds(20000).front();
    MedianHashIndex::Options options;
    options.threads = 2;
    MedianHashIndex index;
    index.build(cloud.view(), nullptr, options);
    RadiusNeighborhoods table;
    index.radiusAll(0.05, table);
    Neighborhoods nearest;
    index.nearestKAll(3, nearest);
    int failed = table.size() == cloud.size() && nearest.size() == cloud.size() ? 0 : 1;
    const auto throws = [&](const auto& search) {
      try {
        search();
        failed = 1;
      } catch (const std::bad_alloc&) {
      }
    };
    throws([&] { index.radiusAll(1e6, table); });
    throws([&] { index.nearestKAll(100000, nearest); });
    throws([&] {
      std::vector<std::vector<pcl::index_t>> indices;
      std::vector<std::vector<float>> distances;
      index.radiusBatch(cloud.view(), 1e6, indices, distances, 0, true);
    });
    std::exit(failed + static_cast<int>(table.size() + nearest.size()));
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(lacks_memory(), testing::ExitedWithCode(0), "");
}
#endif

}  // namespace
}  // namespace segorient::test
