// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/point_representation.h>
#include <pcl/point_types.h>
#include <segorient/search/median_hash.h>

#include <algorithm>
#include <array>
#include <thread>

#include "bad_clouds.h"
#include "brute_force.h"
#include "search_clouds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using OurTree = search::MedianHash<pcl::PointXYZ>;
using PclTree = pcl::search::KdTree<pcl::PointXYZ>;

Cloud::Ptr toPcl(const SearchCloud& from) {
  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const float* p = from.view()[i];
    cloud->push_back({p[0], p[1], p[2]});
    if (!isFinite(p)) cloud->is_dense = false;
  }
  return cloud;
}

bool finite(const pcl::PointXYZ& p) {
  return isFinite(p.data);
}

// Every second index, from the end.
pcl::IndicesPtr someIndices(const Cloud& cloud) {
  auto indices = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 1; i < cloud.size(); i += 2) {
    indices->push_back(static_cast<pcl::index_t>(cloud.size() - i));
  }
  return indices;
}

struct Found {
  pcl::Indices indices{1, 2, 3};  // what was there before must go
  std::vector<float> distances{1.0F};
  int count = -1;

  bool operator==(const Found& o) const {
    return count == o.count && indices == o.indices && distances == o.distances;
  }
  bool consistent() const {
    return indices.size() == static_cast<std::size_t>(count) && distances.size() == indices.size();
  }
};

class OnCloud : public testing::TestWithParam<SearchCloud> {};

TEST_P(OnCloud, OverloadsAgree) {
  const auto cloud = toPcl(GetParam());
  for (const auto& indices : {pcl::IndicesPtr(), someIndices(*cloud)}) {
    OurTree tree;
    tree.setInputCloud(cloud, indices);
    EXPECT_EQ(tree.getInputCloud(), cloud);
    EXPECT_EQ(tree.getIndices(), indices);
    std::vector<pcl::Indices> batch_indices;
    std::vector<std::vector<float>> batch_distances;
    tree.nearestKSearch(*cloud, {}, 9, batch_indices, batch_distances);
    ASSERT_EQ(batch_indices.size(), cloud->size());
    std::vector<pcl::Indices> batch_radius_indices;
    std::vector<std::vector<float>> batch_radius_distances;
    tree.radiusSearch(*cloud, {}, 0.2, batch_radius_indices, batch_radius_distances, 12);
    ASSERT_EQ(batch_radius_distances.size(), cloud->size());
    for (pcl::index_t position = 0; position < 300; position += 7) {
      const auto index = indices ? (*indices)[static_cast<std::size_t>(position)] : position;
      const auto at = static_cast<std::size_t>(index);
      Found a;
      Found b;
      Found c;
      a.count = tree.nearestKSearch((*cloud)[at], 9, a.indices, a.distances);
      b.count = tree.nearestKSearch(*cloud, index, 9, b.indices, b.distances);
      c.count = tree.nearestKSearch(position, 9, c.indices, c.distances);
      EXPECT_TRUE(a.consistent());
      EXPECT_EQ(a.count, finite((*cloud)[at]) ? 9 : 0);
      EXPECT_EQ(a, b);
      EXPECT_EQ(a, c);
      EXPECT_EQ(a.indices, batch_indices[at]);
      EXPECT_EQ(a.distances, batch_distances[at]);
      a.count = tree.radiusSearch((*cloud)[at], 0.2, a.indices, a.distances, 12);
      b.count = tree.radiusSearch(*cloud, index, 0.2, b.indices, b.distances, 12);
      c.count = tree.radiusSearch(position, 0.2, c.indices, c.distances, 12);
      EXPECT_TRUE(a.consistent());
      EXPECT_EQ(a, b);
      EXPECT_EQ(a, c);
      EXPECT_EQ(a.indices, batch_radius_indices[at]);
      EXPECT_EQ(a.distances, batch_radius_distances[at]);
    }
  }
}

// What PCL asks of a search method: unique, valid, ascending, complete; here against brute force.
TEST_P(OnCloud, ResultsOverIndexViewsAndK) {
  const SearchCloud& points = GetParam();
  const auto cloud = toPcl(points);
  for (const auto& indices : {pcl::IndicesPtr(), someIndices(*cloud)}) {
    OurTree tree;
    tree.setInputCloud(cloud, indices);
    for (std::size_t at = 0; at < cloud->size(); at += 131) {
      if (!finite((*cloud)[at])) continue;
      const auto expected = bruteForce(points.view(), points.view()[at], indices.get());
      for (const int k : {1, 8, 64, 512}) {
        Found found;
        found.count = tree.nearestKSearch((*cloud)[at], k, found.indices, found.distances);
        ASSERT_TRUE(found.consistent());
        ASSERT_EQ(found.indices.size(), std::min(static_cast<std::size_t>(k), expected.size()));
        for (std::size_t i = 0; i < found.indices.size(); ++i) {
          ASSERT_EQ(found.indices[i], expected[i].index);
          ASSERT_EQ(found.distances[i], expected[i].distance);
        }
      }
    }
  }
}

TEST_P(OnCloud, DistancesAreThoseOfPclToTheLastBit) {
  const SearchCloud& points = GetParam();
  if (points.name == "overflowing squares" || points.name == "largest floats") {
    GTEST_SKIP() << "PCL's kd-tree finds nothing at an infinite distance";
  }
  const auto cloud = toPcl(points);
  OurTree ours;
  ours.setInputCloud(cloud);
  PclTree pcls;
  pcls.setInputCloud(cloud);
  for (std::size_t at = 0; at < cloud->size(); at += 17) {
    if (!finite((*cloud)[at])) continue;
    Found a;
    Found b;
    a.count = ours.nearestKSearch((*cloud)[at], 20, a.indices, a.distances);
    b.count = pcls.nearestKSearch((*cloud)[at], 20, b.indices, b.distances);
    ASSERT_EQ(a.count, b.count);
    ASSERT_EQ(a.distances, b.distances);
    const double radius = std::sqrt(static_cast<double>(a.distances.back()));
    a.count = ours.radiusSearch((*cloud)[at], radius, a.indices, a.distances);
    b.count = pcls.radiusSearch((*cloud)[at], radius, b.indices, b.distances);
    ASSERT_EQ(a.count, b.count);
    ASSERT_EQ(a.distances, b.distances);
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, OnCloud, testing::ValuesIn(searchClouds(1000)));

TEST(MedianHash, AllPointsEqualsQueryByQuery) {
  const auto cloud = toPcl(searchClouds(3000).at(1));
  OurTree tree;
  for (const auto& indices : {pcl::IndicesPtr(), someIndices(*cloud)}) {
    tree.setInputCloud(cloud, indices);
    Neighborhoods table;
    tree.nearestKSearchAll(12, table);
    const std::size_t rows = indices ? indices->size() : cloud->size();
    ASSERT_EQ(table.size(), rows);
    Found found;
    for (std::size_t i = 0; i < rows; ++i) {
      found.count =
          tree.nearestKSearch(static_cast<pcl::index_t>(i), 12, found.indices, found.distances);
      ASSERT_EQ(found.count, table.count(i));
      ASSERT_EQ(found.indices, pcl::Indices(table.indices(i), table.indices(i) + found.count));
    }
  }
}

TEST(MedianHash, SettersAndGetters) {
  OurTree tree;
  EXPECT_EQ(tree.getName(), "MedianHash");
  EXPECT_EQ(tree.getRegionSize(), 4096U);
  EXPECT_EQ(tree.getNumberOfThreads(), 0U);
  tree.setRegionSize(500);
  tree.setNumberOfThreads(3);
  EXPECT_EQ(tree.getRegionSize(), 500U);
  EXPECT_EQ(tree.getNumberOfThreads(), 3U);
  tree.setEpsilon(0.5F);
  EXPECT_EQ(tree.getEpsilon(), 0.5F);
  const auto cloud = toPcl(searchClouds(1000).front());
  tree.setInputCloud(cloud);
  EXPECT_EQ(tree.getEpsilon(), 0.5F) << "settings stay";
  EXPECT_TRUE(tree.getSortedResults());
}

TEST(MedianHash, EpsilonSetThroughTheBaseIsHeard) {
  const auto cloud = toPcl(searchClouds(20000).front());
  const auto tree = pcl::make_shared<OurTree>();
  tree->setInputCloud(cloud);
  const PclTree::Ptr base = tree;
  const auto sum = [&] {
    double total = 0.0;
    Found found;
    for (std::size_t i = 0; i < cloud->size(); i += 10) {
      base->nearestKSearch((*cloud)[i], 10, found.indices, found.distances);
      for (const float d : found.distances) total += static_cast<double>(d);
    }
    return total;
  };
  const double exact = sum();
  base->setEpsilon(3.0F);
  const double approximate = sum();
  EXPECT_GT(approximate, exact);
  EXPECT_LT(approximate, 16.0 * exact);
}

TEST(MedianHash, UnsortedRadiusHasTheSameContent) {
  const auto cloud = toPcl(searchClouds(3000).front());
  OurTree tree(false);
  EXPECT_FALSE(tree.getSortedResults());
  tree.setInputCloud(cloud);
  Found unsorted;
  unsorted.count = tree.radiusSearch(0, 0.3, unsorted.indices, unsorted.distances);
  tree.setSortedResults(true);
  Found sorted;
  sorted.count = tree.radiusSearch(0, 0.3, sorted.indices, sorted.distances);
  ASSERT_GT(sorted.count, 3);
  EXPECT_TRUE(std::is_sorted(sorted.distances.begin(), sorted.distances.end()));
  EXPECT_EQ(unsorted.count, sorted.count);
  std::sort(unsorted.indices.begin(), unsorted.indices.end());
  std::sort(sorted.indices.begin(), sorted.indices.end());
  EXPECT_EQ(unsorted.indices, sorted.indices);
}

// x and y only, x in another unit: as PCL searches with it.
class Flat : public pcl::PointRepresentation<pcl::PointXYZ> {
 public:
  Flat() { nr_dimensions_ = 2; }
  void copyToFloatArray(const pcl::PointXYZ& p, float* out) const override {
    out[0] = 5.0F * p.x;
    out[1] = p.y;
  }
};

// A fourth dimension.
class Lifted : public pcl::PointRepresentation<pcl::PointXYZ> {
 public:
  Lifted() { nr_dimensions_ = 4; }
  void copyToFloatArray(const pcl::PointXYZ& p, float* out) const override {
    out[0] = p.x;
    out[1] = p.y;
    out[2] = p.z;
    out[3] = p.x * p.y;
  }
};

template <typename Representation>
void expectSameAsPcl() {
  const auto cloud = toPcl(searchClouds(2000).front());
  const auto representation = pcl::make_shared<Representation>();
  OurTree ours;
  ours.setInputCloud(cloud);
  ours.setPointRepresentation(representation);
  PclTree pcls;
  pcls.setPointRepresentation(representation);
  pcls.setInputCloud(cloud);
  for (std::size_t at = 0; at < cloud->size(); at += 13) {
    Found a;
    Found b;
    a.count = ours.nearestKSearch((*cloud)[at], 10, a.indices, a.distances);
    b.count = pcls.nearestKSearch((*cloud)[at], 10, b.indices, b.distances);
    ASSERT_EQ(a, b);
    a.count = ours.radiusSearch((*cloud)[at], 0.2, a.indices, a.distances);
    b.count = pcls.radiusSearch((*cloud)[at], 0.2, b.indices, b.distances);
    ASSERT_EQ(a, b);
  }
}

TEST(MedianHash, PointRepresentationIsHonoured) {
  expectSameAsPcl<Flat>();
}
TEST(MedianHash, FourDimensionsAreSearchedByPcl) {
  expectSameAsPcl<Lifted>();
}

TEST(MedianHash, FourDimensionsOnBadInput) {
  const QuietPcl quiet;
  const double infinity = std::numeric_limits<double>::infinity();
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    OurTree tree;
    tree.setPointRepresentation(pcl::make_shared<Lifted>());
    tree.setInputCloud(bad.cloud, index.indices);
    for (const pcl::PointXYZ& q : {pcl::PointXYZ(0.1F, 0.2F, 0.3F), pcl::PointXYZ(NAN, 0, 0)}) {
      Found found;
      for (const int k : {-1, 0, 1, 5, std::numeric_limits<int>::max()}) {
        const int count = tree.nearestKSearch(q, k, found.indices, found.distances);
        ASSERT_EQ(found.indices.size(), static_cast<std::size_t>(count)) << k;
        ASSERT_LE(count, std::max(k, 0));
        ASSERT_TRUE(count == 0 || !std::isnan(q.x));
      }
      for (const double radius : {-1.0, 0.0, std::nan(""), -infinity}) {
        ASSERT_EQ(tree.radiusSearch(q, radius, found.indices, found.distances), 0) << radius;
        ASSERT_TRUE(found.indices.empty());
      }
      const int count = tree.radiusSearch(q, 0.5, found.indices, found.distances);
      ASSERT_EQ(found.indices.size(), static_cast<std::size_t>(count));
    }
  });
}

TEST(MedianHash, OtherPointTypes) {
  const SearchCloud points = searchClouds(1000).front();
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZRGBNormal>>();
  for (std::size_t i = 0; i < points.size(); ++i) {
    pcl::PointXYZRGBNormal p;
    std::copy(points.view()[i], points.view()[i] + 3, p.data);
    cloud->push_back(p);
  }
  search::MedianHash<pcl::PointXYZRGBNormal> tree;
  tree.setInputCloud(cloud);
  for (std::size_t at = 0; at < points.size(); at += 50) {
    Found found;
    found.count = tree.nearestKSearch((*cloud)[at], 8, found.indices, found.distances);
    const auto expected = bruteForce(points.view(), points.view()[at]);
    for (std::size_t i = 0; i < 8; ++i) ASSERT_EQ(found.indices[i], expected[i].index);
    // a query of another type
    found.count = tree.nearestKSearchT(
        pcl::PointXYZ(points.view()[at][0], points.view()[at][1], points.view()[at][2]), 8,
        found.indices, found.distances);
    ASSERT_EQ(found.count, 8);
    for (std::size_t i = 0; i < 8; ++i) ASSERT_EQ(found.indices[i], expected[i].index);
  }
}

TEST(MedianHash, ConcurrentQueriesOnOneObject) {
  const auto cloud = toPcl(searchClouds(4000).at(1));
  OurTree tree;
  tree.setRegionSize(500);
  tree.setInputCloud(cloud);
  std::vector<Found> expected(cloud->size());
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    expected[i].count = tree.nearestKSearch(static_cast<pcl::index_t>(i), 6, expected[i].indices,
                                            expected[i].distances);
  }
  std::vector<std::thread> threads;
  std::array<int, 4> wrong{};
  for (std::size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([&, t] {
      Found found;
      for (std::size_t j = 0; j < cloud->size(); ++j) {
        const std::size_t i = (j * (2 * t + 1)) % cloud->size();
        found.count = tree.nearestKSearch((*cloud)[i], 6, found.indices, found.distances);
        if (!(found == expected[i])) ++wrong[t];
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(wrong, (std::array<int, 4>{}));
}

// Two threads ask for the rows of all points, two for lists of points, each all of it.
TEST(MedianHash, ConcurrentBatchesOnOneObject) {
  const auto cloud = toPcl(searchClouds(4000).at(1));
  OurTree tree;
  tree.setRegionSize(500);
  tree.setNumberOfThreads(2);
  tree.setInputCloud(cloud);
  constexpr double kRadius = 0.05;
  Neighborhoods rows;
  RadiusNeighborhoods spheres;
  tree.nearestKSearchAll(9, rows);
  tree.radiusSearchAll(kRadius, spheres);
  std::vector<pcl::Indices> nearest;
  std::vector<pcl::Indices> within;
  std::vector<std::vector<float>> distances;
  tree.nearestKSearch(*cloud, {}, 9, nearest, distances);
  tree.radiusSearch(*cloud, {}, kRadius, within, distances);
  std::vector<std::thread> threads;
  std::array<int, 4> wrong{};
  for (std::size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int round = 0; round < 3; ++round) {
        if (t % 2 == 0) {
          Neighborhoods own_rows;
          RadiusNeighborhoods own_spheres;
          tree.nearestKSearchAll(9, own_rows);
          tree.radiusSearchAll(kRadius, own_spheres);
          for (std::size_t i = 0; i < cloud->size(); ++i) {
            wrong[t] += std::equal(own_rows.indices(i), own_rows.indices(i) + own_rows.count(i),
                                   rows.indices(i), rows.indices(i) + rows.count(i))
                            ? 0
                            : 1;
            wrong[t] +=
                std::equal(own_spheres.indices(i), own_spheres.indices(i) + own_spheres.count(i),
                           spheres.indices(i), spheres.indices(i) + spheres.count(i))
                    ? 0
                    : 1;
          }
        } else {
          std::vector<pcl::Indices> found;
          std::vector<std::vector<float>> own_distances;
          tree.nearestKSearch(*cloud, {}, 9, found, own_distances);
          wrong[t] += found == nearest ? 0 : 1;
          tree.radiusSearch(*cloud, {}, kRadius, found, own_distances);
          wrong[t] += found == within ? 0 : 1;
        }
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(wrong, (std::array<int, 4>{}));
}

}  // namespace
}  // namespace segorient::test
