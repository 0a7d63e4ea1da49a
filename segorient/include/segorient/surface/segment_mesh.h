// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// How triangles are taken away from a Delaunay triangulation (paper, section 3.2.1).
struct TriangulationSettings {
  /// A bin of the histogram of edge lengths counts as a maximum if it holds more than this share of
  /// the fullest one; the last such bin gives the critical length.
  float kappa1 = 0.1F;
  /// Triangles on the boundary go if they have an edge longer than this share of the critical
  /// length.
  float kappa2 = 0.7F;
  /// Critical length over the right end of that bin. 1 is the paper's rule; it tears holes where
  /// points are random.
  float critical_factor = 2.F;
  /// Bins between the shortest and the longest edge (the paper); 0 = as wide as a quarter of the
  /// median.
  int bins = 0;
  /// Fills what random sampling leaves open: pockets along straight sides, and holes no larger than
  /// the largest empty circle that so many random points are likely to have. False is the paper's
  /// rule.
  bool fill_gaps = true;
};

/// The same with the number of threads.
struct TriangulationOptions : TriangulationSettings {
  int threads = 0;  ///< 0 = all cores; no result depends on it
};

/// A segment's triangulation and its boundary. All points are indices into the cloud.
struct SegmentMesh {
  /// Counter-clockwise as seen from where the segment's reference normal points to.
  std::vector<std::array<pcl::index_t, 3>> triangles;
  /// Closed boundary curves, one after the other; the mesh is on their left.
  std::vector<pcl::index_t> boundary;
  std::vector<std::uint32_t> loops;      ///< loop i: boundary[loops[i], loops[i + 1])
  std::vector<std::uint8_t> is_hole;     ///< by loop: 1 = around a hole, 0 = outer
  std::vector<pcl::index_t> duplicates;  ///< points that fall onto another one: in no triangle
  /// All points but the duplicates where there is no triangle: fewer than three, or all in a line.
  std::vector<pcl::index_t> loose;
  double area = 0;            ///< of the triangles, in space
  float critical_length = 0;  ///< L_c; 0 without triangles

  std::size_t loopCount() const { return is_hole.size(); }
};

/// Triangulates points that a plane can be seen through: projection, Delaunay, removal of long
/// triangles.
///
/// Every point is in a triangle, in `duplicates` or in `loose`. Each edge has one or two triangles,
/// each boundary point exactly one boundary curve through it. O(n log n). \param members points of
/// one segment, without repetition \param normal reference normal; anything not finite or zero
/// leaves all points loose
SEGORIENT_SURFACE_EXPORT SegmentMesh triangulatePoints(const PointView& points,
                                                       const pcl::index_t* members,
                                                       std::size_t count,
                                                       const std::array<float, 3>& normal,
                                                       const TriangulationOptions& options);

/// The regular segments' meshes by label; with `all` also the others'. The rest stays empty.
SEGORIENT_SURFACE_EXPORT std::vector<SegmentMesh> triangulateSegments(
    const PointView& points, const Segmentation& segmentation, const TriangulationOptions& options,
    bool all = false);

}  // namespace segorient
