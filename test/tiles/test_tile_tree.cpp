// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tiles/tile_tree.h"

namespace segorient::test {
namespace {

using Place = TileTree::Place;

// A sheet whose density falls by a hundred from one end to the other, and a small cluster far away.
std::vector<Place> unevenSheet(std::size_t n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Place> out;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = std::pow(uniform(random), 3.0);
    out.push_back({100.0 * x, 100.0 * uniform(random), std::sin(10.0 * x)});
  }
  for (std::size_t i = 0; i < n / 20; ++i) {
    out.push_back({500.0 + uniform(random), uniform(random), uniform(random)});
  }
  return out;
}

TEST(TileTree, TilesHoldNoMorePointsThanTheyMay) {
  const std::vector<Place> points = unevenSheet(20000);
  const TileTree tree(points, 1.0, 1500.0);
  std::vector<int> count(tree.tiles(), 0);
  double reach = 0.0;
  for (const Place& p : points) ++count[tree.owner(p, reach)];
  EXPECT_GE(tree.tiles(), points.size() / 1500);
  EXPECT_LE(*std::max_element(count.begin(), count.end()), 1500);
  EXPECT_GT(*std::min_element(count.begin(), count.end()), 0);
}

TEST(TileTree, EveryPlaceHasOneOwnerAtNoDistance) {
  const std::vector<Place> points = unevenSheet(5000);
  const TileTree tree(points, 1.0, 400.0);
  for (const Place& p : points) {
    double reach = 0.0;
    const std::uint32_t owner = tree.owner(p, reach);
    int owners = 0;
    tree.forEachWithin(p, reach, [&](std::uint32_t tile, double distance) {
      if (tile != owner) {
        EXPECT_LE(distance, reach);
        return;
      }
      EXPECT_EQ(distance, 0.0);
      ++owners;
    });
    EXPECT_EQ(owners, 1);
  }
}

// What wholeRadius() promises, by brute force: all points so near are in the tile, too.
TEST(TileTree, CellsOfSeveralPlacesAreThoseOfEach) {
  const std::vector<Place> points = unevenSheet(3000);
  const TileTree tree(points, 1.0, 400.0);
  std::vector<std::uint32_t> cells(points.size());
  tree.findCells(points.data(), points.size(), cells.data());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(cells[i], tree.cellOf(points[i]));
}

TEST(TileTree, WithinTheWholeRadiusNoPointIsMissing) {
  const std::vector<Place> points = unevenSheet(3000);
  const TileTree tree(points, 1.0, 600.0);
  std::vector<std::vector<bool>> in(tree.tiles(), std::vector<bool>(points.size(), false));
  std::vector<double> reach(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.owner(points[i], reach[i]);
    tree.forEachWithin(points[i], reach[i],
                       [&](std::uint32_t tile, double) { in[tile][i] = true; });
  }
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.forEachWithin(points[i], reach[i], [&](std::uint32_t tile, double distance) {
      if (distance == 0.0) return;
      const double radius = tree.wholeRadius(points[i], reach[i], distance);
      for (std::size_t j = 0; j < points.size(); ++j) {
        double square = 0.0;
        for (std::size_t a = 0; a < 3; ++a) {
          square += (points[i][a] - points[j][a]) * (points[i][a] - points[j][a]);
        }
        if (radius <= 0.0 || square >= radius * radius) continue;
        EXPECT_TRUE(in[tile][j]);
        ++looked_at;
      }
    });
  }
  EXPECT_GT(looked_at, 10000U);
}

// Floats near one origin would not resolve both of two bodies that are far apart.
TEST(TileTree, BodiesThatAreFarApartAreTilesOfTheirOwn) {
  std::vector<TileTree::Place> places;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 900; ++i) {
    places.push_back({uniform(random) + (i % 9 == 0 ? 1e6 : 0.0), uniform(random), 0.0});
  }
  const TileTree tree(places, 1.0, 10000.0);
  EXPECT_EQ(tree.tiles(), 2U);
  double reach = 0.0;
  EXPECT_NE(tree.owner({0.5, 0.5, 0.0}, reach), tree.owner({1e6 + 0.5, 0.5, 0.0}, reach));
  for (TileTree::Place& p : places) p[0] = std::fmod(p[0], 1e6);
  EXPECT_EQ(TileTree(places, 1.0, 10000.0).tiles(), 1U);
}

// Copies that floats cannot tell apart are no spacing.
TEST(TileTree, NearCopiesDoNotCutATile) {
  std::vector<TileTree::Place> places;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 500; ++i) {
    const double x = uniform(random);
    const double y = uniform(random);
    for (int copy = 0; copy < 6; ++copy) places.push_back({x + 1e-8 * copy, y, 0.0});
  }
  EXPECT_EQ(TileTree(places, 1.0, 10000.0).tiles(), 1U);
}

TEST(TileTree, AllInOnePlaceIsOneTileAndSoIsNothing) {
  const TileTree same(std::vector<Place>(1000, Place{1.0, 2.0, 3.0}), 1.0, 10.0);
  EXPECT_EQ(same.tiles(), 1U);
  const TileTree none(std::vector<Place>{}, 1.0, 10.0);
  EXPECT_EQ(none.tiles(), 1U);
  double reach = -1.0;
  EXPECT_EQ(none.owner({0.0, 0.0, 0.0}, reach), 0U);
}

TEST(TileTree, RepeatedCoordinatesAreNotCutApart) {
  std::vector<Place> points;
  for (int i = 0; i < 4000; ++i) points.push_back({static_cast<double>(i % 4), 0.0, 0.0});
  const TileTree tree(points, 1.0, 100.0);
  EXPECT_EQ(tree.tiles(), 4U);
}

}  // namespace
}  // namespace segorient::test
