// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash.h>

#include <cmath>
#include <functional>
#include <limits>

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Tree = search::MedianHash<pcl::PointXYZ>;

const float kNan = std::numeric_limits<float>::quiet_NaN();
const float kInf = std::numeric_limits<float>::infinity();

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
                       auto& d) { return t.nearestKSearch(pcl::PointXYZ(0, kNan, 0), 3, i, d); }},
      {"infinite query",
       [](auto& t, auto& i, auto& d) {
         return t.nearestKSearch(pcl::PointXYZ(kInf, 0, 0), 3, i, d);
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
         return t.radiusSearch(pcl::PointXYZ(kNan, 0, 0), 1.0, i, d);
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

TEST(BadInput, OnlyInvalidPoints) {
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < 100; ++i) cloud->push_back({kNan, 0.0F, kInf});
  for (const bool dense : {true, false}) {
    cloud->is_dense = dense;
    Tree tree;
    tree.setInputCloud(cloud);
    expectFindsNothing(tree);
  }
}

TEST(BadInput, InvalidPointsAreLeftOutWhateverIsDenseSays) {
  for (const bool dense : {true, false}) {
    const auto cloud = smallCloud();
    (*cloud)[1].y = kNan;
    (*cloud)[3].z = -kInf;
    cloud->is_dense = dense;
    Tree tree;
    tree.setInputCloud(cloud);
    pcl::Indices indices;
    std::vector<float> distances;
    EXPECT_EQ(tree.nearestKSearch((*cloud)[0], 10, indices, distances), 3);
    EXPECT_EQ(indices, (pcl::Indices{0, 2, 4}));
    EXPECT_EQ(tree.nearestKSearch(1, 10, indices, distances), 0);
    Neighborhoods table;
    tree.nearestKSearchAll(2, table);
    ASSERT_EQ(table.size(), 5U);
    EXPECT_EQ(table.count(0), 2);
    EXPECT_EQ(table.count(1), 0);
    EXPECT_EQ(table.count(3), 0);
  }
}

TEST(BadInput, RepeatedIndicesAreFoundRepeatedly) {
  auto indices = pcl::make_shared<pcl::Indices>();
  *indices = {3, 1, 3, 1, 3};
  Tree tree;
  tree.setInputCloud(smallCloud(), indices);
  pcl::Indices found;
  std::vector<float> distances;
  EXPECT_EQ(tree.nearestKSearch(0, 10, found, distances), 5);
  EXPECT_EQ(found, (pcl::Indices{3, 3, 3, 1, 1}));
}

TEST(BadInput, WideRadii) {
  Tree tree;
  tree.setInputCloud(smallCloud());
  pcl::Indices indices;
  std::vector<float> distances;
  for (const double radius : {1e19, 1e20, 1e200, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(tree.radiusSearch(0, radius, indices, distances), 5) << radius;
    EXPECT_EQ(tree.radiusSearch(0, radius, indices, distances, 2), 2) << radius;
    EXPECT_EQ(indices, (pcl::Indices{0, 1}));
  }
}

TEST(BadInput, KBeyondTheCloud) {
  Tree tree;
  tree.setInputCloud(smallCloud());
  pcl::Indices indices;
  std::vector<float> distances;
  EXPECT_EQ(tree.nearestKSearch(0, std::numeric_limits<int>::max(), indices, distances), 5);
  Neighborhoods table;
  tree.nearestKSearchAll(0, table);
  EXPECT_EQ(table.count(4), 0);
  tree.nearestKSearchAll(-5, table);
  EXPECT_EQ(table.count(4), 0);
  tree.nearestKSearchAll(1000, table);
  EXPECT_EQ(table.count(4), 5);
}

TEST(BadInput, OddSettings) {
  for (const std::size_t region_size : {std::size_t{0}, std::size_t{1}, ~std::size_t{0}}) {
    Tree tree;
    tree.setRegionSize(region_size);
    tree.setNumberOfThreads(std::numeric_limits<unsigned int>::max());
    tree.setNumberOfThreads(1);
    tree.setInputCloud(smallCloud());
    for (const float epsilon : {kNan, -1.0F, 0.0F}) {
      tree.setEpsilon(epsilon);
      pcl::Indices indices;
      std::vector<float> distances;
      EXPECT_EQ(tree.nearestKSearch(4, 2, indices, distances), 2);
      EXPECT_EQ(indices, (pcl::Indices{4, 3})) << "not a tolerance: exact";
    }
  }
}

}  // namespace
}  // namespace segorient::test
