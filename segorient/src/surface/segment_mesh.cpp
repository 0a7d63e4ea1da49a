// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/surface/segment_mesh.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "common/parallel_for.h"
#include "surface/triangle_selection.h"

namespace segorient {
namespace {

constexpr std::uint32_t kNone = PlanarTriangulation::kNone;

/// Members of a segment seen along its normal, on the integer grid.
class Projection {
 public:
  Projection(const PointView& points, const pcl::index_t* members, std::size_t count,
             const Eigen::Vector3d& normal)
      : points_(points), members_(members), count_(count) {
    origin_ = at(0);
    u_ = normal.unitOrthogonal();
    v_ = normal.cross(u_);
  }

  Eigen::Vector3d at(std::size_t i) const {
    const float* p = points_[static_cast<std::size_t>(members_[i])];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }

  /// Power of two that brings the points onto the grid, so that only the last step rounds.
  double scale() const { return scale_; }

  std::vector<GridPoint> onGrid() {
    double extent = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3d d = at(i) - origin_;
      extent = std::max({extent, std::abs(d.dot(u_)), std::abs(d.dot(v_))});
    }
    int exponent = 0;
    std::frexp(extent, &exponent);
    scale_ = std::ldexp(static_cast<double>(kGridLimit), -exponent);
    std::vector<GridPoint> grid(count_);
    for (std::size_t i = 0; i < count_ && extent > 0; ++i) {
      const Eigen::Vector3d d = at(i) - origin_;
      grid[i].x = static_cast<std::int32_t>(std::lround(scale_ * d.dot(u_)));
      grid[i].y = static_cast<std::int32_t>(std::lround(scale_ * d.dot(v_)));
    }
    return grid;
  }

 private:
  const PointView& points_;
  const pcl::index_t* members_;
  std::size_t count_;
  double scale_ = 1;
  Eigen::Vector3d origin_;
  Eigen::Vector3d u_;
  Eigen::Vector3d v_;
};

// Lengths in space, in units of the grid: no float overflows.
std::vector<float> edgeLengths(const PlanarTriangulation& mesh, const Projection& projection) {
  std::vector<float> lengths;
  lengths.reserve(mesh.edges.size());
  for (const auto& edge : mesh.edges) {
    const double length = (projection.at(edge.points[0]) - projection.at(edge.points[1])).norm();
    lengths.push_back(static_cast<float>(length * projection.scale()));
  }
  return lengths;
}

// Boundary curves of the kept triangles. Every boundary point has one curve through it, so
// following the only edge that leaves a point is enough.
void traceLoops(const PlanarTriangulation& mesh, const std::vector<std::uint8_t>& kept,
                const std::vector<GridPoint>& grid, const pcl::index_t* members,
                SegmentMesh& result) {
  std::vector<std::uint32_t> next(grid.size(), kNone);
  for (std::uint32_t t = 0; t < kept.size(); ++t) {
    if (kept[t] == 0) continue;
    const auto& triangle = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& sides = mesh.edges[triangle.edges[i]].triangles;
      const std::uint32_t other = sides[0] == t ? sides[1] : sides[0];
      if (other == kNone || kept[other] == 0)
        next[triangle.points[i]] = triangle.points[(i + 1) % 3];
    }
  }
  result.loops.push_back(0);
  for (std::uint32_t start = 0; start < next.size(); ++start) {
    if (next[start] == kNone) continue;
    double twice_area = 0;
    for (std::uint32_t p = start; next[p] != kNone;) {
      result.boundary.push_back(members[p]);
      const std::uint32_t q = next[p];
      next[p] = kNone;
      const GridPoint& o = grid[start];
      twice_area +=
          (static_cast<double>(grid[p].x) - o.x) * (static_cast<double>(grid[q].y) - o.y) -
          (static_cast<double>(grid[q].x) - o.x) * (static_cast<double>(grid[p].y) - o.y);
      p = q;
    }
    result.loops.push_back(static_cast<std::uint32_t>(result.boundary.size()));
    result.is_hole.push_back(twice_area < 0 ? 1 : 0);
  }
}

// All members that are no duplicates.
void addLoose(const std::vector<pcl::index_t>& members,
              const std::vector<std::uint32_t>& duplicates, std::vector<pcl::index_t>& loose) {
  for (std::size_t i = 0, d = 0; i < members.size(); ++i) {
    if (d < duplicates.size() && duplicates[d] == i) {
      ++d;
    } else {
      loose.push_back(members[i]);
    }
  }
}

}  // namespace

SegmentMesh triangulatePoints(const PointView& points, const pcl::index_t* members,
                              std::size_t count, const std::array<float, 3>& normal,
                              const TriangulationOptions& options) {
  SegmentMesh result;
  const Eigen::Vector3d direction = Eigen::Vector3f(normal.data()).cast<double>().normalized();
  std::vector<pcl::index_t> finite;
  for (std::size_t i = 0; i < count; ++i) {
    const bool good = isFinite(points[static_cast<std::size_t>(members[i])]);
    (good ? finite : result.loose).push_back(members[i]);
  }
  if (finite.size() < 3 || !direction.allFinite() || direction.squaredNorm() < 0.5) {
    result.loose.assign(members, members + count);
    return result;
  }
  Projection projection(points, finite.data(), finite.size(), direction);
  const std::vector<GridPoint> grid = projection.onGrid();
  const PlanarTriangulation mesh = triangulate(grid);
  for (const std::uint32_t p : mesh.duplicates) result.duplicates.push_back(finite[p]);
  if (mesh.triangles.empty()) {
    addLoose(finite, mesh.duplicates, result.loose);
    return result;
  }
  const surface::Selection selection =
      surface::selectTriangles(mesh, edgeLengths(mesh, projection), finite.size(), options);
  result.critical_length =
      static_cast<float>(static_cast<double>(selection.critical_length) / projection.scale());
  for (std::uint32_t t = 0; t < selection.kept.size(); ++t) {
    if (selection.kept[t] == 0) continue;
    const auto& p = mesh.triangles[t].points;
    result.triangles.push_back({finite[p[0]], finite[p[1]], finite[p[2]]});
    const Eigen::Vector3d a = projection.at(p[0]);
    result.area += 0.5 * (projection.at(p[1]) - a).cross(projection.at(p[2]) - a).norm();
  }
  traceLoops(mesh, selection.kept, grid, finite.data(), result);
  return result;
}

std::vector<SegmentMesh> triangulateSegments(const PointView& points,
                                             const Segmentation& segmentation,
                                             const TriangulationOptions& options, bool all) {
  constexpr double kPointTime = 1500.0;  // ns, see resolveThreads()
  std::vector<SegmentMesh> meshes(segmentation.segments.size());
  const double time = timeOfEach(meshes.size(), segmentation.members.size(), kPointTime);
  parallelFor(meshes.size(), options.threads, time, [&](std::size_t s) {
    const Segment& segment = segmentation.segments[s];
    if (!all && segment.kind != SegmentKind::REGULAR) return;
    meshes[s] = triangulatePoints(points, segmentation.begin(s), segment.size,
                                  segment.reference_normal, options);
  });
  return meshes;
}

}  // namespace segorient
