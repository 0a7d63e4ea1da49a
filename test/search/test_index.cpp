// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <thread>

#include "brute_force.h"
#include "search_clouds.h"

namespace segorient::test {
namespace {

using search::MedianHashIndex;

std::vector<Neighbor> nearestK(const MedianHashIndex& index, const float* query, int k,
                               float epsilon = 0.0F) {
  std::vector<pcl::index_t> indices(static_cast<std::size_t>(k));
  std::vector<float> distances(static_cast<std::size_t>(k));
  const int found = index.nearestK(query, k, indices.data(), distances.data(), epsilon);
  std::vector<Neighbor> result;
  for (std::size_t i = 0; i < static_cast<std::size_t>(found); ++i) {
    result.push_back({distances[i], indices[i]});
  }
  return result;
}

std::vector<Neighbor> radius(const MedianHashIndex& index, const float* query, double r,
                             unsigned int max_nn, bool sorted) {
  std::vector<pcl::index_t> indices;
  std::vector<float> distances;
  const int found = index.radius(query, r, indices, distances, max_nn, sorted);
  EXPECT_EQ(indices.size(), static_cast<std::size_t>(found));
  EXPECT_EQ(distances.size(), static_cast<std::size_t>(found));
  std::vector<Neighbor> result;
  for (std::size_t i = 0; i < indices.size(); ++i) result.push_back({distances[i], indices[i]});
  return result;
}

std::vector<Neighbor> prefix(std::vector<Neighbor> all, std::size_t k) {
  all.resize(std::min(k, all.size()));
  return all;
}

// Points of the cloud, near them, and far outside.
std::vector<std::array<float, 3>> queries(const SearchCloud& cloud) {
  std::vector<std::array<float, 3>> result;
  const PointView view = cloud.view();
  for (std::size_t i = 0; i < view.size; i += 1 + view.size / 10) {
    const float* p = view[i];
    if (!isFinite(p)) continue;
    result.push_back({p[0], p[1], p[2]});
    result.push_back({p[0] * 1.01F, p[1] * 0.99F, p[2]});
    result.push_back({p[1] * 3.0F, p[2], p[0] - p[1]});
  }
  result.push_back({1e3F, -1e3F, 1e3F});
  result.push_back({-1e12F, 0.0F, 0.0F});
  result.push_back({3e38F, 3e38F, -3e38F});
  result.push_back({0.0F, 0.0F, 0.0F});
  return result;
}

class IndexOnCloud : public testing::TestWithParam<SearchCloud> {};

TEST_P(IndexOnCloud, NearestKEqualsBruteForce) {
  const SearchCloud& cloud = GetParam();
  std::vector<MedianHashIndex> built(3);
  for (std::size_t i = 0; i < built.size(); ++i) {
    MedianHashIndex::Options options;
    options.region_size = i == 0 ? 16 : i == 1 ? 200 : 2048;
    built[i].build(cloud.view(), nullptr, options);
  }
  for (const auto& query : queries(cloud)) {
    if (!isFinite(query.data())) continue;
    const auto expected = bruteForce(cloud.view(), query.data());
    for (const MedianHashIndex& index : built) {
      ASSERT_EQ(index.size(), expected.size());
      for (const int k : {1, 2, 8, 15, 64, 512, 100000}) {
        ASSERT_EQ(nearestK(index, query.data(), k), prefix(expected, static_cast<std::size_t>(k)))
            << "k " << k << ", query " << query[0] << ' ' << query[1] << ' ' << query[2];
      }
    }
  }
}

// Walks in steps shorter than the distance to a point's neighbours, with a jump now and then.
std::vector<std::array<float, 3>> walk(const SearchCloud& cloud) {
  std::vector<std::array<float, 3>> result;
  const PointView view = cloud.view();
  for (std::size_t i = 0; i < view.size; i += 1 + view.size / 4) {
    const float* p = view[i];
    if (!isFinite(p)) continue;
    const auto near = prefix(bruteForce(view, p), 8);
    const float step = 0.3F * std::sqrt(near.back().distance);
    for (int j = 0; j < 25; ++j) {
      const auto t = static_cast<float>(j);
      const std::array<float, 3> q{p[0] + t * step, p[1] - t * step, p[2] + 0.5F * t * step};
      if (isFinite(q.data())) result.push_back(q);
    }
  }
  return result;
}

TEST_P(IndexOnCloud, QueriesNextToEachOtherEqualBruteForce) {
  const SearchCloud& cloud = GetParam();
  std::vector<MedianHashIndex> built(2);
  for (std::size_t i = 0; i < built.size(); ++i) {
    MedianHashIndex::Options options;
    options.region_size = i == 0 ? 50 : 2048;
    built[i].build(cloud.view(), nullptr, options);
  }
  const auto queries = walk(cloud);
  std::vector<std::vector<Neighbor>> expected;
  for (const auto& q : queries) expected.push_back(prefix(bruteForce(cloud.view(), q.data()), 60));
  const auto check = [&](const MedianHashIndex& index, std::size_t i, int k) {
    ASSERT_EQ(nearestK(index, queries[i].data(), k),
              prefix(expected[i], static_cast<std::size_t>(k)))
        << "k " << k << ", query " << i;
  };
  for (const int k : {1, 5, 15, 60}) {
    for (const MedianHashIndex& index : built) {
      for (std::size_t i = 0; i < queries.size(); ++i) check(index, i, k);
    }
  }
  // In turn, so that nothing that was kept for one index or k is used for another.
  for (std::size_t i = 0; i < queries.size(); ++i) {
    check(built[i % 2], i, 15);
    check(built[(i / 2) % 2], i, i % 3 == 0 ? 5 : 15);
  }
}

TEST_P(IndexOnCloud, RadiusEqualsBruteForce) {
  const SearchCloud& cloud = GetParam();
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, {});
  for (const auto& query : queries(cloud)) {
    if (!isFinite(query.data())) continue;
    const auto all = bruteForce(cloud.view(), query.data());
    for (const std::size_t rank : {std::size_t{0}, std::size_t{5}, std::size_t{40}, all.size()}) {
      const double r =
          rank < all.size() ? std::sqrt(static_cast<double>(all[rank].distance)) : 1e20;
      const auto limit = static_cast<float>(r * r);
      std::vector<Neighbor> expected;
      for (const Neighbor& n : all) {
        if (n.distance < limit) expected.push_back(n);
      }
      ASSERT_EQ(radius(index, query.data(), r, 0, true), expected) << "radius " << r;
      ASSERT_EQ(radius(index, query.data(), r, 7, true), prefix(expected, 7));
      auto unsorted = radius(index, query.data(), r, 0, false);
      std::sort(unsorted.begin(), unsorted.end());
      ASSERT_EQ(unsorted, expected);
      auto closest = radius(index, query.data(), r, 7, false);
      std::sort(closest.begin(), closest.end());
      ASSERT_EQ(closest, prefix(expected, 7));
    }
  }
}

TEST_P(IndexOnCloud, SubsetOfIndices) {
  const SearchCloud& cloud = GetParam();
  std::vector<pcl::index_t> indices;
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    indices.push_back(static_cast<pcl::index_t>(cloud.size() - 1 - i));
  }
  indices.push_back(indices.front());  // found twice
  indices.push_back(-1);
  indices.push_back(static_cast<pcl::index_t>(cloud.size()));
  MedianHashIndex index;
  index.build(cloud.view(), &indices, {});
  for (const auto& query : queries(cloud)) {
    if (!isFinite(query.data())) continue;
    const auto expected = bruteForce(cloud.view(), query.data(), &indices);
    ASSERT_EQ(index.size(), expected.size());
    ASSERT_EQ(nearestK(index, query.data(), 20), prefix(expected, 20));
  }
}

TEST_P(IndexOnCloud, ApproximateKeepsItsPromise) {
  const SearchCloud& cloud = GetParam();
  MedianHashIndex::Options options;
  options.region_size = 64;
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, options);
  for (const auto& query : queries(cloud)) {
    if (!isFinite(query.data())) continue;
    const auto exact = prefix(bruteForce(cloud.view(), query.data()), 20);
    for (const float epsilon : {0.1F, 1.0F, 10.0F}) {
      const auto found = nearestK(index, query.data(), 20, epsilon);
      ASSERT_EQ(found.size(), exact.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (!std::isfinite(exact[i].distance)) continue;
        // 1e-6: rounding of the distances themselves; 1e-22: that of the smallest squares
        ASSERT_LE(std::sqrt(static_cast<double>(found[i].distance)),
                  (1.0 + static_cast<double>(epsilon)) * (1.0 + 1e-6) *
                          std::sqrt(static_cast<double>(exact[i].distance)) +
                      1e-22);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, IndexOnCloud, testing::ValuesIn(searchClouds(1000)));

// A thread that has not searched before has no room from earlier queries; with a point that far
// away no radius can be guessed either.
TEST(Index, FirstQueryOfAThread) {
  for (std::size_t size = 1; size < 70; ++size) {
    std::vector<float> rows{1e30F, std::numeric_limits<float>::max(), 1.0F};
    for (std::size_t i = 0; i < size; ++i) {
      rows.insert(rows.end(), {static_cast<float>(i % 7), static_cast<float>(i / 7), 0.0F});
    }
    const PointView view{rows.data(), 3, size + 1};
    MedianHashIndex index;
    index.build(view, nullptr, {});
    const std::array<float, 3> query{-67.0F, -82.0F, -79.0F};
    const std::size_t k = std::min<std::size_t>(4, size);
    std::vector<Neighbor> found;
    std::thread([&] { found = nearestK(index, query.data(), static_cast<int>(k)); }).join();
    EXPECT_EQ(found, prefix(bruteForce(view, query.data()), k)) << size;
  }
}

// Two places with many points each between others. Whatever was asked before, in which of two
// structures and for how many, must not answer for another one.
TEST(Index, QueriesWherePointsCrowd) {
  const std::array<std::array<float, 3>, 2> places{{{0.5F, 0.5F, 0.5F}, {0.75F, 0.5F, 0.25F}}};
  std::mt19937 rng(31);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  for (int i = 0; i < 12000; ++i) {
    if (i % 3 == 0) {
      rows.insert(rows.end(), {unit(rng), unit(rng), unit(rng)});
    } else {
      const auto& p = places[static_cast<std::size_t>(i) / 5 % 2];
      rows.insert(rows.end(), p.begin(), p.end());
    }
  }
  const PointView view{rows.data(), 3, 12000};
  std::vector<pcl::index_t> others;
  for (pcl::index_t i = 11999; i > 0; i -= 2) others.push_back(i);
  std::array<MedianHashIndex, 2> built;
  built[0].build(view, nullptr, {});
  built[1].build(view, &others, {});
  for (std::size_t i = 0; i < 64; ++i) {
    const std::array<float, 3>& q = places[rng() % 2];
    const std::size_t k = rng() % 2 == 0 ? 7 : 20;
    const std::size_t which = rng() % 2;
    EXPECT_EQ(nearestK(built[which], q.data(), static_cast<int>(k)),
              prefix(bruteForce(view, q.data(), which == 1 ? &others : nullptr), k))
        << i;
  }
  std::vector<float> turned;  // the same points, other indices
  for (std::size_t i = 12000; i-- > 0;) turned.insert(turned.end(), &rows[3 * i], &rows[3 * i] + 3);
  const PointView other{turned.data(), 3, 12000};
  nearestK(built[0], places[0].data(), 7);
  built[0].build(other, nullptr, {});
  EXPECT_EQ(nearestK(built[0], places[0].data(), 7),
            prefix(bruteForce(other, places[0].data()), 7));
}

// A query for many neighbours leaves more room to the thread; what is approximate must not change.
TEST(Index, ApproximateAnswersDoNotDependOnEarlierQueries) {
  std::mt19937 rng(32);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  for (int i = 0; i < 34000; ++i) {
    const float scale = i % 17 < 15 ? 0.01F : 1.F;
    for (int a = 0; a < 3; ++a) rows.push_back(scale * unit(rng));
  }
  const PointView view{rows.data(), 3, 34000};
  MedianHashIndex index;
  index.build(view, nullptr, {});
  const auto ask = [&] {
    std::vector<std::vector<Neighbor>> found;
    for (std::size_t i = 0; i < 34000; i += 40) found.push_back(nearestK(index, view[i], 5, 1.F));
    return found;
  };
  std::vector<std::vector<Neighbor>> fresh;
  std::vector<std::vector<Neighbor>> later;
  std::thread([&] { fresh = ask(); }).join();
  std::thread([&] {
    nearestK(index, view[0], 9000);
    later = ask();
  }).join();
  EXPECT_EQ(fresh, later);
}

// Points row by row on a grid, and the same ones shuffled.
TEST(Index, ApproximateQueriesAreExactWherePointsAreInOrder) {
  constexpr int kEdge = 150;
  std::vector<std::array<float, 3>> points;
  std::mt19937 rng(33);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  for (int i = 0; i < kEdge * kEdge; ++i) {
    points.push_back({static_cast<float>(i % kEdge) + unit(rng),
                      static_cast<float>(i / kEdge) + unit(rng), unit(rng)});
  }
  const auto wrong = [&] {
    const PointView view{points.front().data(), 3, points.size()};
    MedianHashIndex index;
    index.build(view, nullptr, {});
    int count = 0;
    for (std::size_t i = 0; i < points.size(); i += 40) {
      count += nearestK(index, view[i], 15, 3.F) == nearestK(index, view[i], 15) ? 0 : 1;
    }
    return count;
  };
  EXPECT_EQ(wrong(), 0);
  std::shuffle(points.begin(), points.end(), rng);
  EXPECT_GT(wrong(), 0);
}

TEST(Index, EverySmallSize) {
  for (std::size_t n = 0; n < 40; ++n) {
    SearchCloud cloud = searchClouds(std::max<std::size_t>(n, 1)).front();
    cloud.xyz.resize(4 * n);
    MedianHashIndex::Options options;
    options.region_size = 1 + n % 5;
    MedianHashIndex index;
    index.build(cloud.view(), nullptr, options);
    const std::array<float, 3> query{0.1F, 0.2F, 0.3F};
    for (int k = 0; k < 45; ++k) {
      ASSERT_EQ(nearestK(index, query.data(), k),
                prefix(bruteForce(cloud.view(), query.data()), static_cast<std::size_t>(k)));
    }
  }
}

TEST(Index, ConcurrentQueriesOnOneObject) {
  const SearchCloud cloud = searchClouds(4000).at(1);
  MedianHashIndex::Options options;
  options.region_size = 500;
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, options);
  std::vector<std::vector<Neighbor>> expected;
  for (std::size_t i = 0; i < cloud.size(); i += 4) {
    expected.push_back(nearestK(index, cloud.view()[i], 10));
  }
  std::vector<std::thread> threads;
  std::array<std::size_t, 4> wrong{};
  for (std::size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t j = 0; j < expected.size(); ++j) {
        const std::size_t at = (j * (2 * t + 1)) % expected.size();
        const float* query = cloud.view()[4 * at];
        if (!(nearestK(index, query, 10) == expected[at])) ++wrong[t];
        if (radius(index, query, 0.1, 10, true).empty()) ++wrong[t];
      }
    });
  }
  for (auto& thread : threads) thread.join();
  for (const std::size_t w : wrong) EXPECT_EQ(w, 0U);
}

TEST(Index, MemoryIsThatOfThePointsAndLittleMore) {
  const SearchCloud cloud = searchClouds(20000).front();
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, {});
  const std::size_t points = cloud.size() * (3 * sizeof(float) + sizeof(std::uint32_t));
  EXPECT_GE(index.memory(), points);
  EXPECT_LT(index.memory(), 3 * points);
}

// More points than 32 bits number, all of them the same one: refused before memory is asked for.
TEST(Index, MoreThanItNumbersAreNotTaken) {
  const float point[3] = {1.F, 2.F, 3.F};
  MedianHashIndex index;
  index.build({point, 0, MedianHashIndex::kMostPoints + 1}, nullptr, {});
  EXPECT_EQ(index.size(), 0U);
  Neighborhoods table;
  index.nearestKAll(5, table);
  EXPECT_EQ(table.size(), 0U);
  index.build({point, 0, 4}, nullptr, {});
  EXPECT_EQ(index.size(), 4U);
}

}  // namespace
}  // namespace segorient::test
