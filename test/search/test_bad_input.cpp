// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "bad_clouds.h"
#include "brute_force.h"
#include "search_clouds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Tree = search::MedianHash<pcl::PointXYZ>;

Cloud::Ptr smallCloud() {
  auto cloud = pcl::make_shared<Cloud>();
  for (const float x : {0.0F, 1.0F, 2.0F, 4.0F, 8.0F}) cloud->push_back({x, 0.0F, 0.0F});
  return cloud;
}

struct Case {
  const char* what;
  std::function<int(const Tree&, pcl::Indices&, std::vector<float>&)> ask;
};

// Asked of a small cloud, all of these find nothing.
const std::vector<Case>& emptyAnswers() {
  static const std::vector<Case> cases{
      {"k = 0", [](auto& t, auto& i, auto& d) { return t.nearestKSearch(0, 0, i, d); }},
      {"k < 0", [](auto& t, auto& i, auto& d) { return t.nearestKSearch(0, -3, i, d); }},
      {"least k",
       [](auto& t, auto& i, auto& d) {
         return t.nearestKSearch(0, std::numeric_limits<int>::min(), i, d);
       }},
      {"NaN query", [](auto& t, auto& i,
                       auto& d) { return t.nearestKSearch(pcl::PointXYZ(0, kNaN, 0), 3, i, d); }},
      {"infinite query",
       [](auto& t, auto& i, auto& d) {
         return t.nearestKSearch(pcl::PointXYZ(kInfinity, 0, 0), 3, i, d);
       }},
      {"negative index", [](auto& t, auto& i, auto& d) { return t.nearestKSearch(-1, 3, i, d); }},
      {"index too large", [](auto& t, auto& i, auto& d) { return t.nearestKSearch(5, 3, i, d); }},
      {"index outside another cloud",
       [](auto& t, auto& i, auto& d) { return t.nearestKSearch(Cloud(), 0, 3, i, d); }},
      {"radius 0", [](auto& t, auto& i, auto& d) { return t.radiusSearch(0, 0.0, i, d); }},
      {"negative radius", [](auto& t, auto& i, auto& d) { return t.radiusSearch(0, -1.0, i, d); }},
      {"NaN radius",
       [](auto& t, auto& i, auto& d) {
         return t.radiusSearch(0, std::numeric_limits<double>::quiet_NaN(), i, d);
       }},
      {"NaN query, radius",
       [](auto& t, auto& i, auto& d) {
         return t.radiusSearch(pcl::PointXYZ(kNaN, 0, 0), 1.0, i, d);
       }},
      {"negative index, radius",
       [](auto& t, auto& i, auto& d) { return t.radiusSearch(-1, 1.0, i, d); }},
      {"index too large, radius",
       [](auto& t, auto& i, auto& d) { return t.radiusSearch(5, 1.0, i, d); }},
      {"index outside another cloud, radius",
       [](auto& t, auto& i, auto& d) { return t.radiusSearch(Cloud(), 7, 1.0, i, d); }},
  };
  return cases;
}

void expectEmpty(const Tree& tree, const Case& c) {
  pcl::Indices indices{1, 2};
  std::vector<float> distances{3.0F};
  EXPECT_EQ(c.ask(tree, indices, distances), 0) << c.what;
  EXPECT_TRUE(indices.empty()) << c.what;
  EXPECT_TRUE(distances.empty()) << c.what;
}

void expectFindsNothing(const Tree& tree) {
  for (const Case& c : emptyAnswers()) expectEmpty(tree, c);
  expectEmpty(tree, {"any point", [](auto& t, auto& i, auto& d) {
                       return t.nearestKSearch(pcl::PointXYZ(0, 0, 0), 3, i, d);
                     }});
  expectEmpty(tree, {"any sphere", [](auto& t, auto& i, auto& d) {
                       return t.radiusSearch(pcl::PointXYZ(0, 0, 0), 1e20, i, d);
                     }});
  Neighborhoods table;
  tree.nearestKSearchAll(3, table);
  for (std::size_t i = 0; i < table.size(); ++i) EXPECT_EQ(table.count(i), 0);
}

TEST(BadInput, QueriesThatFindNothing) {
  Tree tree;
  tree.setInputCloud(smallCloud());
  for (const Case& c : emptyAnswers()) expectEmpty(tree, c);
}

TEST(BadInput, TreesWithoutPoints) {
  {
    const Tree never_set;
    expectFindsNothing(never_set);
  }
  Tree tree;
  tree.setInputCloud(nullptr);
  expectFindsNothing(tree);
  tree.setInputCloud(smallCloud());  // usable again
  pcl::Indices indices;
  std::vector<float> distances;
  EXPECT_EQ(tree.nearestKSearch(0, 2, indices, distances), 2);
  tree.setInputCloud(pcl::make_shared<Cloud>());
  expectFindsNothing(tree);
  tree.setInputCloud(smallCloud(), pcl::make_shared<pcl::Indices>());
  expectFindsNothing(tree);
  auto bad = pcl::make_shared<pcl::Indices>();
  *bad = {-1, 5, std::numeric_limits<pcl::index_t>::max(),
          std::numeric_limits<pcl::index_t>::min()};
  tree.setInputCloud(smallCloud(), bad);
  expectFindsNothing(tree);
}

// What brute force finds, in the rounding of one distance at a time.
class EveryCloud : public testing::Test {
 protected:
  void ask(const Cloud& cloud, const pcl::PointXYZ* query, const pcl::IndicesPtr& indices) {
    const PointView view{cloud.empty() ? nullptr : &cloud[0].x, 4, cloud.size()};
    std::vector<Neighbor> truth;
    if (query != nullptr) truth = bruteForce(view, &query->x, indices.get());
    const pcl::PointXYZ point = query != nullptr ? *query : pcl::PointXYZ(kNaN, 0.F, 0.F);
    pcl::Indices found;
    std::vector<float> distances;
    for (const int k : {-5, 0, 1, 7, 1000, std::numeric_limits<int>::max()}) {
      SCOPED_TRACE("k " + std::to_string(k));
      const std::size_t most = k < 0 ? 0 : std::min(static_cast<std::size_t>(k), truth.size());
      EXPECT_EQ(tree_.nearestKSearch(point, k, found, distances), static_cast<int>(most));
      compare(truth, most, found, distances);
    }
    for (const double radius : {kNaN + 0.0, -1.0, 0.0, 1e-32, 0.3, 1e20, kInfinity + 0.0}) {
      SCOPED_TRACE("radius " + std::to_string(radius));
      const auto square = static_cast<float>(radius * radius);
      const auto within = static_cast<std::size_t>(
          std::count_if(truth.begin(), truth.end(), [&](const Neighbor& n) {
            return radius > 0.0 && n.distance < square;  // strictly, as FLANN
          }));
      EXPECT_EQ(tree_.radiusSearch(point, radius, found, distances), static_cast<int>(within));
      compare(truth, within, found, distances);
    }
  }

  static void compare(const std::vector<Neighbor>& truth, std::size_t count,
                      const pcl::Indices& found, const std::vector<float>& distances) {
    ASSERT_EQ(found.size(), count);
    ASSERT_EQ(distances.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(found[i], truth[i].index) << i;
      ASSERT_EQ(distances[i], truth[i].distance) << i;
    }
  }

  const QuietPcl quiet_;
  Tree tree_;  // one for all clouds: what it held before must not matter
};

TEST_F(EveryCloud, EqualsBruteForceWhateverTheIndicesAndTheQuery) {
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    const Cloud& cloud = *bad.cloud;
    tree_.setInputCloud(bad.cloud, index.indices);
    ask(cloud, nullptr, index.indices);
    const pcl::PointXYZ elsewhere(0.3F, -0.2F, 0.1F);
    ask(cloud, &elsewhere, index.indices);
    for (std::size_t row = 0; row < cloud.size(); row += 75) {
      ask(cloud, pointOf(cloud, nullptr, row), index.indices);
    }
  });
}

TEST_F(EveryCloud, RowsOfAllPointsAreThoseOfBruteForce) {
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    const Cloud& cloud = *bad.cloud;
    const PointView view{cloud.empty() ? nullptr : &cloud[0].x, 4, cloud.size()};
    tree_.setInputCloud(bad.cloud, index.indices);
    const std::size_t rows = index.indices ? index.indices->size() : cloud.size();
    Neighborhoods table;
    for (const int k : {-5, 0, 1, 7, 1000}) {
      tree_.nearestKSearchAll(k, table);
      if (cloud.empty()) continue;  // an error; there are no rows to speak of
      ASSERT_EQ(table.size(), rows);
      for (std::size_t row = 0; row < rows; row += 11) {
        std::vector<Neighbor> truth;
        if (pointOf(cloud, index.indices, row) != nullptr && k > 0) {
          const auto self = index.indices ? (*index.indices)[row] : static_cast<pcl::index_t>(row);
          truth = bruteForceRow(view, self, static_cast<std::size_t>(k), index.indices.get());
        }
        ASSERT_EQ(table.count(row), static_cast<int>(truth.size())) << "k " << k;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          ASSERT_EQ(table.indices(row)[i], truth[i].index) << "k " << k << " row " << row;
          ASSERT_EQ(table.sqrDistances(row)[i], truth[i].distance);
        }
      }
    }
  });
}

TEST_F(EveryCloud, SpheresAroundAllPointsAreThoseOfSingleQueries) {
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    const Cloud& cloud = *bad.cloud;
    tree_.setInputCloud(bad.cloud, index.indices);
    const std::size_t rows = index.indices ? index.indices->size() : cloud.size();
    RadiusNeighborhoods table;
    for (const double radius : {kNaN + 0.0, -1.0, 0.0, 0.3, 1e20, kInfinity + 0.0}) {
      tree_.radiusSearchAll(radius, table);
      if (cloud.empty()) continue;
      ASSERT_EQ(table.size(), rows);
      for (std::size_t row = 0; row < rows; row += 17) {
        pcl::Indices single;
        std::vector<float> distances;
        if (pointOf(cloud, index.indices, row) != nullptr) {
          tree_.radiusSearch(static_cast<pcl::index_t>(row), radius, single, distances);
        }
        pcl::Indices found(table.indices(row), table.indices(row) + table.count(row));
        std::sort(single.begin(), single.end());
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, single) << "radius " << radius << " row " << row;
      }
    }
  });
}

TEST_F(EveryCloud, BatchesAreManySingleQueries) {
  forEachBadInput([&](const BadCloud& bad, const IndexCase& index) {
    const Cloud& cloud = *bad.cloud;
    tree_.setInputCloud(bad.cloud, index.indices);
    const pcl::Indices asked{0, -1, 3, 0, std::numeric_limits<pcl::index_t>::max(), 149};
    std::vector<pcl::Indices> found;
    std::vector<std::vector<float>> distances;
    pcl::Indices single;
    std::vector<float> single_distances;
    for (const int k : {-5, 0, 7, 1000}) {
      tree_.nearestKSearch(cloud, asked, k, found, distances);
      ASSERT_EQ(found.size(), asked.size());
      for (std::size_t i = 0; i < asked.size(); ++i) {
        tree_.nearestKSearch(cloud, asked[i], k, single, single_distances);
        ASSERT_EQ(found[i], single) << "k " << k;
        ASSERT_EQ(distances[i], single_distances) << "k " << k;
      }
    }
    for (const double radius : {kNaN + 0.0, -1.0, 0.3, kInfinity + 0.0}) {
      tree_.radiusSearch(cloud, asked, radius, found, distances);
      ASSERT_EQ(found.size(), asked.size());
      for (std::size_t i = 0; i < asked.size(); ++i) {
        tree_.radiusSearch(cloud, asked[i], radius, single, single_distances);
        ASSERT_EQ(found[i], single) << "radius " << radius;
      }
    }
  });
}

TEST(BadInput, ClosestWithinWideRadii) {
  Tree tree;
  tree.setInputCloud(smallCloud());
  pcl::Indices indices;
  std::vector<float> distances;
  for (const double radius : {1e19, 1e200, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(tree.radiusSearch(0, radius, indices, distances, 2), 2) << radius;
    EXPECT_EQ(indices, (pcl::Indices{0, 1}));
  }
}

TEST(BadInput, OddSettings) {
  for (const std::size_t region_size : {std::size_t{0}, std::size_t{1}, ~std::size_t{0}}) {
    Tree tree;
    tree.setRegionSize(region_size);
    tree.setNumberOfThreads(std::numeric_limits<unsigned int>::max());
    tree.setNumberOfThreads(1);
    tree.setInputCloud(smallCloud());
    for (const float epsilon : {kNaN, -1.0F, 0.0F}) {
      tree.setEpsilon(epsilon);
      pcl::Indices indices;
      std::vector<float> distances;
      EXPECT_EQ(tree.nearestKSearch(4, 2, indices, distances), 2);
      EXPECT_EQ(indices, (pcl::Indices{4, 3})) << "not a tolerance: exact";
    }
  }
}

// The index below the class, which others call as well.
TEST(BadQuery, NothingIsNearAQueryThatIsNowhere) {
  const SearchCloud cloud = searchClouds(500)[0];
  search::MedianHashIndex index;
  index.build(cloud.view(), nullptr, {});
  std::vector<float> queries;
  for (const float bad : {kNaN, kInfinity, -kInfinity}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<float, 3> query{0.F, 0.F, 0.F};
      query[axis] = bad;
      pcl::index_t near[4];
      float squared[4];
      EXPECT_EQ(index.nearestK(query.data(), 4, near, squared, 0.F), 0);
      std::vector<pcl::index_t> inside{1};
      std::vector<float> distances{1.F};
      EXPECT_EQ(index.radius(query.data(), 1e3, inside, distances, 0, true), 0);
      EXPECT_TRUE(inside.empty() && distances.empty());
      queries.insert(queries.end(), query.begin(), query.end());
    }
  }
  std::vector<std::vector<pcl::index_t>> indices;
  std::vector<std::vector<float>> distances;
  index.nearestKBatch({queries.data(), 3, 9}, 4, indices, distances, 0.F);
  ASSERT_EQ(indices.size(), 9U);
  for (const auto& row : indices) EXPECT_TRUE(row.empty());
  for (const auto& row : distances) EXPECT_TRUE(row.empty());
}

}  // namespace
}  // namespace segorient::test
