// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/triangulated_boundary.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "orientation/paper/boundary_ballot.h"

namespace segorient {
namespace {

using Eigen::Vector3f;

Vector3f pointAt(const PointView& points, pcl::index_t row) {
  const float* p = points[static_cast<std::size_t>(row)];
  return {p[0], p[1], p[2]};
}

// Unit direction of the boundary at its points, zero at all others; by row.
class BoundaryDirections {
 public:
  BoundaryDirections(const PointView& points, const std::vector<SegmentMesh>& meshes)
      : directions_(points.size, Vector3f::Zero()) {
    for (const SegmentMesh& mesh : meshes) {
      for (std::size_t loop = 0; loop < mesh.loopCount(); ++loop) {
        addLoop(points, mesh, mesh.loops[loop], mesh.loops[loop + 1] - mesh.loops[loop]);
      }
    }
  }

  const Vector3f& at(pcl::index_t row) const { return directions_[static_cast<std::size_t>(row)]; }

 private:
  void addLoop(const PointView& points, const SegmentMesh& mesh, std::uint32_t first,
               std::uint32_t size) {
    if (size < 3) return;
    const std::uint32_t span = std::min(2U, (size - 1) / 2);  // points before and after
    for (std::uint32_t i = 0; i < size; ++i) {
      const pcl::index_t before = mesh.boundary[first + (i + size - span) % size];
      const pcl::index_t after = mesh.boundary[first + (i + span) % size];
      const Vector3f way = pointAt(points, after) - pointAt(points, before);
      const float length = way.norm();
      if (!(length > 0.F)) continue;
      directions_[static_cast<std::size_t>(mesh.boundary[first + i])] = way / length;
    }
  }

  std::vector<Vector3f> directions_;
};

}  // namespace

std::vector<BoundaryVote> triangulatedBoundaryVotes(const PointView& points,
                                                    const Segmentation& segmentation,
                                                    const SegmentGraph& links,
                                                    const std::vector<SegmentMesh>& meshes) {
  std::vector<BoundaryVote> out(links.borders.size());
  if (meshes.size() != segmentation.segments.size()) return out;
  const BoundaryDirections directions(points, meshes);
  for (std::size_t l = 0; l < links.borders.size(); ++l) {
    BoundaryBallot ballot;
    std::vector<pcl::index_t> voters_a;
    std::vector<pcl::index_t> voters_b;
    const SegmentBorder& link = links.borders[l];
    for (std::uint32_t i = link.first; i < link.first + link.size; ++i) {
      const BorderPair& pair = links.pairs[i];
      const Vector3f& in_a = directions.at(pair.in_a);
      const Vector3f& in_b = directions.at(pair.in_b);
      if (in_a.isZero(0.F) || in_b.isZero(0.F)) continue;
      ballot.add(-in_a.dot(in_b));
      voters_a.push_back(pair.in_a);
      voters_b.push_back(pair.in_b);
    }
    keepDistinct(voters_a);
    keepDistinct(voters_b);
    out[l] = ballot.count(std::min(voters_a.size(), voters_b.size()));
  }
  return out;
}

}  // namespace segorient
