// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "surface/delaunay.h"

#include <boost/polygon/voronoi_builder.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace segorient {
namespace {

std::int64_t orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const std::int64_t abx = std::int64_t{b.x} - a.x;
  const std::int64_t aby = std::int64_t{b.y} - a.y;
  const std::int64_t acx = std::int64_t{c.x} - a.x;
  const std::int64_t acy = std::int64_t{c.y} - a.y;
  return abx * acy - aby * acx;
}

/// Takes the place of a Voronoi diagram as output of the sweep: of a new bisector it keeps the
/// Delaunay edge, of a circle event the triangle. That is all we need, in a tenth of the diagram's
/// memory.
class SweepOutput {
 public:
  using Edge = PlanarTriangulation::Edge;

  SweepOutput(const std::vector<GridPoint>& points, const std::vector<std::uint32_t>& order,
              PlanarTriangulation& result)
      : points_(points), order_(order), result_(result) {}

  // The names are those that boost::polygon::voronoi_builder calls.
  // NOLINTBEGIN(readability-identifier-naming)
  void _reserve(std::size_t sites) {
    result_.edges.reserve(3 * sites);  // never more: addresses are handed out
    result_.triangles.reserve(2 * sites);
  }

  template <typename Site>
  void _process_single_site(const Site&) {}

  template <typename Site>
  std::pair<void*, void*> _insert_new_edge(const Site& site1, const Site& site2) {
    Edge* edge = addEdge(pointOf(site1), pointOf(site2));
    return {edge, edge};
  }

  template <typename Site, typename Circle>
  std::pair<void*, void*> _insert_new_edge(const Site& site1, const Site& site3, const Circle&,
                                           void* data12, void* data23) {
    const auto* edge12 = static_cast<const Edge*>(data12);
    const auto* edge23 = static_cast<const Edge*>(data23);
    const std::uint32_t a = pointOf(site1);
    const std::uint32_t c = pointOf(site3);
    const std::uint32_t b = edge12->points[0] == a ? edge12->points[1] : edge12->points[0];
    Edge* edge = addEdge(a, c);
    addTriangle({a, b, c}, {indexOf(edge12), indexOf(edge23), indexOf(edge)});
    return {edge, edge};
  }

  void _build() {}
  // NOLINTEND(readability-identifier-naming)

 private:
  template <typename Site>
  std::uint32_t pointOf(const Site& site) const {
    return order_[site.initial_index()];
  }
  std::uint32_t indexOf(const Edge* edge) const {
    return static_cast<std::uint32_t>(edge - result_.edges.data());
  }

  Edge* addEdge(std::uint32_t a, std::uint32_t b) {
    constexpr std::uint32_t kNone = PlanarTriangulation::kNone;
    result_.edges.push_back({{a, b}, {kNone, kNone}});
    return &result_.edges.back();
  }

  void addTriangle(std::array<std::uint32_t, 3> p, std::array<std::uint32_t, 3> e) {
    if (orientation(points_[p[0]], points_[p[1]], points_[p[2]]) < 0) {
      std::swap(p[1], p[2]);
      std::swap(e[0], e[2]);
    }
    const auto index = static_cast<std::uint32_t>(result_.triangles.size());
    result_.triangles.push_back({p, e});
    for (const std::uint32_t edge : e) {
      auto& sides = result_.edges[edge].triangles;
      sides[sides[0] == PlanarTriangulation::kNone ? 0 : 1] = index;
    }
  }

  const std::vector<GridPoint>& points_;
  const std::vector<std::uint32_t>& order_;
  PlanarTriangulation& result_;
};

// One point of each place, the first in the input.
std::vector<std::uint32_t> distinctPoints(const std::vector<GridPoint>& points,
                                          std::vector<std::uint32_t>& duplicates) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (points[a].x != points[b].x) return points[a].x < points[b].x;
    return points[a].y != points[b].y ? points[a].y < points[b].y : a < b;
  });
  std::size_t kept = 0;
  for (const std::uint32_t p : order) {
    if (kept > 0 && points[order[kept - 1]].x == points[p].x &&
        points[order[kept - 1]].y == points[p].y) {
      duplicates.push_back(p);
    } else {
      order[kept++] = p;
    }
  }
  order.resize(kept);
  std::sort(duplicates.begin(), duplicates.end());
  return order;
}

}  // namespace

PlanarTriangulation triangulate(const std::vector<GridPoint>& points) {
  PlanarTriangulation result;
  const std::vector<std::uint32_t> order = distinctPoints(points, result.duplicates);
  boost::polygon::voronoi_builder<std::int32_t> builder;
  for (const std::uint32_t p : order) builder.insert_point(points[p].x, points[p].y);
  SweepOutput output(points, order, result);
  builder.construct(&output);
  return result;
}

}  // namespace segorient
