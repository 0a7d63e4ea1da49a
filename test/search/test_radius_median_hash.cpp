// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash.h>

#include <limits>

#include "search_clouds.h"

namespace segorient::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr toPcl(const SearchCloud& from) {
  auto cloud = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < from.size(); ++i) {
    cloud->push_back({from.view()[i][0], from.view()[i][1], from.view()[i][2]});
  }
  return cloud;
}

TEST(MedianHashRadiusAll, EqualsQueriesByIndex) {
  const auto cloud = toPcl(searchClouds(9000).at(1));
  const auto indices = pcl::make_shared<pcl::Indices>();
  for (pcl::index_t i = 8000; i > 0; i -= 3) indices->push_back(i);
  search::MedianHash<pcl::PointXYZ> tree;
  for (const auto& used : {pcl::IndicesPtr(), indices}) {
    tree.setInputCloud(cloud, used);
    RadiusNeighborhoods table;
    tree.radiusSearchAll(0.06, table, 30);
    ASSERT_EQ(table.size(), used ? used->size() : cloud->size());
    pcl::Indices found;
    std::vector<float> distances;
    for (std::size_t i = 0; i < table.size(); ++i) {
      tree.radiusSearch(static_cast<pcl::index_t>(i), 0.06, found, distances, 30);
      ASSERT_EQ(found, pcl::Indices(table.indices(i), table.indices(i) + table.count(i)));
      ASSERT_EQ(distances,
                std::vector<float>(table.sqrDistances(i), table.sqrDistances(i) + table.count(i)));
    }
  }
}

TEST(MedianHashRadiusAll, NothingToFind) {
  search::MedianHash<pcl::PointXYZ> tree;
  RadiusNeighborhoods table;
  EXPECT_EQ(table.size(), 0U);
  tree.radiusSearchAll(1.0, table);
  EXPECT_EQ(table.size(), 0U);
  EXPECT_EQ(table.entries(), 0U);
  const auto cloud = toPcl(searchClouds(50).front());
  tree.setInputCloud(cloud);
  for (const double radius : {0.0, -1.0, 1e-40, std::numeric_limits<double>::quiet_NaN()}) {
    tree.radiusSearchAll(radius, table);
    EXPECT_EQ(table.size(), cloud->size()) << radius;
    EXPECT_EQ(table.entries(), 0U) << radius;
  }
  tree.radiusSearchAll(std::numeric_limits<double>::infinity(), table);
  EXPECT_EQ(table.entries(), cloud->size() * cloud->size());
}

}  // namespace
}  // namespace segorient::test
