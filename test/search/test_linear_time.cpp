// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Clouds on which a careless search looks at every point for every query: where squared distances
// overflow or vanish, and where density differs by orders of magnitude.
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <random>

#include "brute_force.h"

namespace segorient::test {
namespace {

constexpr std::size_t kPoints = 200000;
constexpr int kNeighbors = 15;

using Coordinates = std::vector<float>;

template <typename Make>
Coordinates cloud(Make&& make) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  Coordinates xyz;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double scale = make(i);
    for (int a = 0; a < 3; ++a) xyz.push_back(static_cast<float>(scale * u(random)));
    xyz.push_back(0.0F);
  }
  return xyz;
}

// Processor time, so that other programs do not count.
double seconds(const Coordinates& xyz, Neighborhoods& table) {
  const std::clock_t start = std::clock();
  search::MedianHashIndex::Options options;
  options.threads = 1;
  search::MedianHashIndex index;
  index.build({xyz.data(), 4, kPoints}, nullptr, options);
  index.nearestKAll(kNeighbors, table);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Case {
  const char* name;
  double (*scale)(std::size_t);
};

class LinearTime : public testing::TestWithParam<Case> {};

// A search that looks at every point takes more than 100 times as long here.
TEST_P(LinearTime, NearUniformClouds) {
  Neighborhoods table;
  const double uniform = seconds(cloud([](std::size_t) { return 1.0; }), table);
  const Coordinates xyz = cloud(GetParam().scale);
  EXPECT_LT(seconds(xyz, table), 30.0 * uniform);
  for (std::size_t i = 0; i < kPoints; i += kPoints / 5 + 1) {
    const auto expected =
        bruteForceRow({xyz.data(), 4, kPoints}, static_cast<pcl::index_t>(i), kNeighbors);
    ASSERT_EQ(table.count(i), kNeighbors);
    for (std::size_t j = 0; j < expected.size(); ++j) {
      ASSERT_EQ(table.indices(i)[j], expected[j].index);
      ASSERT_EQ(table.sqrDistances(i)[j], expected[j].distance);
    }
  }
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Clouds, LinearTime,
    testing::Values(Case{"OverflowingSquares", [](std::size_t) { return 1e30; }},
                    Case{"SomeSquaresOverflow", [](std::size_t) { return 1e20; }},
                    Case{"VanishingSquares", [](std::size_t) { return 1e-30; }},
                    Case{"OnePlace", [](std::size_t) { return 0.0; }},
                    Case{"ManyInOnePlace", [](std::size_t i) { return i % 5 == 0 ? 0.0 : 1.0; }},
                    Case{"ClusterInHugeBox", [](std::size_t i) { return i < 8 ? 1e6 : 1.0; }},
                    Case{"DenseClusterInSparseCloud",
                         [](std::size_t i) { return i % 10 == 0 ? 1.0 : 1e-6; }}),
    nameOf);

}  // namespace
}  // namespace segorient::test
