// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "surface/delaunay.h"

namespace segorient::test {
namespace {

__extension__ using Wide = __int128;
constexpr std::uint32_t kNone = PlanarTriangulation::kNone;

Wide cross(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return Wide{b.x - a.x} * (c.y - a.y) - Wide{b.y - a.y} * (c.x - a.x);
}

bool inCircle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const Wide ax = a.x - d.x;
  const Wide ay = a.y - d.y;
  const Wide bx = b.x - d.x;
  const Wide by = b.y - d.y;
  const Wide cx = c.x - d.x;
  const Wide cy = c.y - d.y;
  const Wide a2 = ax * ax + ay * ay;
  const Wide b2 = bx * bx + by * by;
  const Wide c2 = cx * cx + cy * cy;
  return ax * (by * c2 - b2 * cy) - ay * (bx * c2 - b2 * cx) + a2 * (bx * cy - by * cx) > 0;
}

bool less(const GridPoint& a, const GridPoint& b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

// Twice the area of the convex hull (Andrew's chain).
Wide hullArea(std::vector<GridPoint> points) {
  if (points.size() < 3) return 0;
  std::sort(points.begin(), points.end(), less);
  std::vector<GridPoint> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const GridPoint& p : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  Wide area = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const GridPoint& a = hull[i];
    const GridPoint& b = hull[(i + 1) % hull.size()];
    area += Wide{a.x} * b.y - Wide{a.y} * b.x;
  }
  return area;
}

void expectDelaunay(const std::string& name, const std::vector<GridPoint>& points) {
  SCOPED_TRACE(name);
  const PlanarTriangulation mesh = triangulate(points);
  std::set<std::pair<std::int32_t, std::int32_t>> places;
  std::vector<std::uint32_t> repeated;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!places.emplace(points[i].x, points[i].y).second) repeated.push_back(i);
  }
  EXPECT_EQ(mesh.duplicates, repeated);
  Wide area = 0;
  std::set<std::uint32_t> used;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    used.insert(p.begin(), p.end());
    const Wide twice = cross(points[p[0]], points[p[1]], points[p[2]]);
    ASSERT_GT(twice, 0);
    area += twice;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& edge = mesh.edges[mesh.triangles[t].edges[i]];
      ASSERT_EQ(std::minmax(edge.points[0], edge.points[1]), std::minmax(p[i], p[(i + 1) % 3]));
      ASSERT_TRUE(edge.triangles[0] == t || edge.triangles[1] == t);
      const std::uint32_t other = edge.triangles[0] == t ? edge.triangles[1] : edge.triangles[0];
      if (other == kNone) continue;
      for (const std::uint32_t q : mesh.triangles[other].points) {
        ASSERT_FALSE(inCircle(points[p[0]], points[p[1]], points[p[2]], points[q]));
      }
    }
  }
  EXPECT_TRUE(area == hullArea(points)) << "the triangles do not fill the hull";
  if (!mesh.triangles.empty()) {
    EXPECT_EQ(used.size(), places.size());
  }
}

TEST(Delaunay, FillsTheHullWithEmptyCircles) {
  std::mt19937 rng(1);
  for (const std::int32_t limit : {kGridLimit, 40, 1 << 14}) {
    std::uniform_int_distribution<std::int32_t> at(-limit, limit);
    std::vector<GridPoint> points;
    for (int i = 0; i < 5000; ++i) points.push_back({at(rng), at(rng)});
    expectDelaunay("random within " + std::to_string(limit), points);
  }
}

TEST(Delaunay, CoCircularPoints) {
  std::vector<GridPoint> square;
  std::vector<GridPoint> turned;
  std::vector<GridPoint> hexagonal;
  for (std::int32_t i = 0; i < 60; ++i) {
    for (std::int32_t j = 0; j < 60; ++j) {
      square.push_back({i * 1000000, j * 1000000});
      turned.push_back({i * 300000 - j * 400000, i * 400000 + j * 300000});
      hexagonal.push_back({i * 500000 + j * 250000, j * 433013});
    }
  }
  expectDelaunay("square grid", square);
  expectDelaunay("turned grid", turned);
  expectDelaunay("hexagonal grid", hexagonal);
  std::vector<GridPoint> circles;
  for (int i = 0; i < 1000; ++i) {
    const double angle = i * 2 * M_PI / 1000;
    for (const double radius : {2e8, 1.4e8, 0.6e8}) {
      circles.push_back({static_cast<std::int32_t>(radius * std::cos(angle)),
                         static_cast<std::int32_t>(radius * std::sin(angle))});
    }
  }
  expectDelaunay("circles", circles);
}

TEST(Delaunay, FewAndCollinear) {
  expectDelaunay("none", {});
  expectDelaunay("one", {{3, 4}});
  expectDelaunay("two", {{0, 0}, {1, 1}});
  expectDelaunay("triangle", {{0, 0}, {1, 0}, {0, 1}});
  expectDelaunay("square", {{0, 0}, {1, 0}, {0, 1}, {1, 1}});
  expectDelaunay("one place", {{7, 7}, {7, 7}, {7, 7}});
  for (const GridPoint step : {GridPoint{1, 0}, GridPoint{0, 1}, GridPoint{2, 3}}) {
    std::vector<GridPoint> line;
    for (std::int32_t i = 0; i < 100; ++i) line.push_back({i * step.x, i * step.y});
    EXPECT_TRUE(triangulate(line).triangles.empty());
    line.push_back({-5, 9});
    expectDelaunay("line and one more", line);
  }
}

}  // namespace
}  // namespace segorient::test
