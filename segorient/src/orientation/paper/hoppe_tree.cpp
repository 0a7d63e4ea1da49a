// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/hoppe_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "common/dot.h"
#include "orientation/paper/outward_components.h"

namespace segorient {
namespace {

struct Edge {
  float cost;
  pcl::index_t a;
  pcl::index_t b;
};

bool operator<(const Edge& l, const Edge& r) {
  if (l.cost != r.cost) return l.cost < r.cost;
  return l.a != r.a ? l.a < r.a : l.b < r.b;
}

// Sets of points with known relative signs.
class SignedSets {
 public:
  explicit SignedSets(std::size_t size) : parent_(size), sign_(size, 1), rank_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), pcl::index_t{0});
  }

  struct Place {
    std::size_t root;
    int sign;  // relative to the root
  };

  Place find(std::size_t i) {
    std::size_t root = i;
    int total = 1;
    while (static_cast<std::size_t>(parent_[root]) != root) {
      total *= sign_[root];
      root = static_cast<std::size_t>(parent_[root]);
    }
    int rest = total;
    while (i != root) {  // shortens the path
      const auto next = static_cast<std::size_t>(parent_[i]);
      const std::int8_t own = sign_[i];
      parent_[i] = static_cast<pcl::index_t>(root);
      sign_[i] = static_cast<std::int8_t>(rest);
      rest *= own;
      i = next;
    }
    return {root, total};
  }

  void join(std::size_t a, std::size_t b, int sign) {
    Place pa = find(a);
    Place pb = find(b);
    if (pa.root == pb.root) return;
    if (rank_[pa.root] < rank_[pb.root]) std::swap(pa, pb);
    if (rank_[pa.root] == rank_[pb.root]) ++rank_[pa.root];
    parent_[pb.root] = static_cast<pcl::index_t>(pa.root);
    sign_[pb.root] = static_cast<std::int8_t>(pa.sign * sign * pb.sign);
  }

 private:
  std::vector<pcl::index_t> parent_;
  std::vector<std::int8_t> sign_;
  std::vector<std::uint8_t> rank_;
};

std::vector<Edge> sortedEdges(const PointView& normals, const Neighborhoods& neighborhoods) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < neighborhoods.size(); ++i) {
    const pcl::index_t* row = neighborhoods.indices(i);
    for (int j = 1; j < neighborhoods.count(i); ++j) {
      const float cosine = std::abs(dot(normals[i], normals[static_cast<std::size_t>(row[j])]));
      const float cost = 1.F - std::min(cosine, 1.F);  // rounding may exceed 1
      if (std::isfinite(cost)) edges.push_back({cost, static_cast<pcl::index_t>(i), row[j]});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// Numbers the sets and turns each one's highest point up.
void pointHighestUp(const PointView& points, const PointView& normals, OrientationResult& result) {
  std::vector<std::size_t> highest(result.components.size(), points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (result.point_components[i] < 0) continue;
    std::size_t& top = highest[static_cast<std::size_t>(result.point_components[i])];
    if (top == points.size || points[i][2] > points[top][2]) top = i;
  }
  for (std::size_t c = 0; c < highest.size(); ++c) {
    const std::size_t top = highest[c];
    const float up = normals[top][2] * static_cast<float>(result.point_signs[top]);
    result.components[c].sign = up < 0.F ? std::int8_t{-1} : std::int8_t{1};
    result.components[c].evidence = up;
    result.components[c].confidence = std::min(std::abs(up), 1.F);
    result.components[c].by = DecidedBy::EXTREMAL;
  }
  for (std::size_t i = 0; i < points.size; ++i) {
    if (result.point_components[i] < 0) continue;
    const std::int8_t sign =
        result.components[static_cast<std::size_t>(result.point_components[i])].sign;
    result.point_signs[i] = static_cast<std::int8_t>(sign * result.point_signs[i]);
  }
}

}  // namespace

OrientationResult orientByPointTree(const PointView& points, const PointView& normals,
                                    const Neighborhoods& neighborhoods) {
  const std::size_t n = points.size;
  SignedSets sets(n);
  OrientationResult result;
  result.point_signs.assign(n, 0);
  result.point_confidences.assign(n, 0.F);
  result.point_components.assign(n, -1);
  for (const Edge& edge : sortedEdges(normals, neighborhoods)) {
    const auto a = static_cast<std::size_t>(edge.a);
    const auto b = static_cast<std::size_t>(edge.b);
    sets.join(a, b, dot(normals[a], normals[b]) < 0.F ? -1 : 1);
    result.point_confidences[a] = std::max(result.point_confidences[a], 1.F - edge.cost);
    result.point_confidences[b] = std::max(result.point_confidences[b], 1.F - edge.cost);
  }
  std::vector<std::int32_t> number(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    if (!isFinite(normals[i]) || !isFinite(points[i])) continue;
    const SignedSets::Place place = sets.find(i);
    if (number[place.root] < 0) {
      number[place.root] = static_cast<std::int32_t>(result.components.size());
      result.components.emplace_back();
    }
    result.point_components[i] = number[place.root];
    result.point_signs[i] = static_cast<std::int8_t>(place.sign);
  }
  pointHighestUp(points, normals, result);
  sortComponents(result);
  return result;
}

}  // namespace segorient
