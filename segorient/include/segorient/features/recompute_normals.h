// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/features/local_normals.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// How normals near sharp edges are found again once there are segments (paper, section 2.3.1).
enum class RecomputationRule {
  /// For each segment around a point a quadratic surface through that segment's points only; the
  /// point
  /// joins the segment whose surface passes nearest to it, and takes the surface's normal.
  OneSided,
  /// The paper's: neighbours in segments beyond a sharp edge are replaced by others, and the normal
  /// is
  /// estimated anew from the modified neighbourhood. Labels stay.
  ModifiedNeighborhoods
};

/// Settings of recomputeNormals(). Angles in radians.
struct RecomputationOptions {
  RecomputationRule rule = RecomputationRule::OneSided;
  /// OneSided: a border is sharp for a point if the surfaces of its two sides meet there at this
  /// angle or more.
  float edge_angle = 0.3490659F;
  /// ModifiedNeighborhoods: a border is sharp if the normals across it differ by this on average
  /// (delta). Less than the edge's own angle: both sides' normals have been averaged over the edge.
  float delta = 0.5235988F;
  /// ModifiedNeighborhoods: measure delta between the segments' reference normals, as the paper
  /// does, instead of between neighbouring points across the border. Smooth borders between grown
  /// segments then count as sharp wherever beta exceeds delta.
  bool delta_between_references = false;
  /// ModifiedNeighborhoods: how normals are estimated from the modified neighbourhoods.
  NormalEstimator estimator = NormalEstimator::Plane;
  int k = 0;        ///< neighbours of each row to use beside the point itself; <= 0 = all
  int threads = 0;  ///< see resolveThreads()
};

struct RecomputationReport {
  std::size_t examined = 0;    ///< points with a border in their neighbourhood
  std::size_t recomputed = 0;  ///< points with a new normal
  std::size_t moved = 0;       ///< points with a new label
};

/// Finds the normals near sharp edges again, from one side of the edge only. Old labels and normals
/// are read and new ones written, so the order of the points does not matter; it may be repeated,
/// with or without segmenting anew in between.
///
/// Does nothing if sizes do not agree.
/// \param regular per label whether the segment is a regular one
/// \param labels per point its segment, -1 for none
/// \param normals 4 floats a point as from estimateNormals(); the curvature stays, and a
///        new normal points to the side of the old one
RecomputationReport recomputeNormals(const PointView& points, const Neighborhoods& neighborhoods,
                                     const std::vector<std::uint8_t>& regular,
                                     const RecomputationOptions& options,
                                     std::vector<std::int32_t>& labels,
                                     std::vector<float>& normals);

/// The same for a cloud as it comes, with NaN points and duplicates, and neighbours still to be
/// found: works on the distinct finite points. All arrays have one entry a point of the cloud.
/// \param indices points to use; others, and entries out of range, stay as they are
/// \param neighborhoods of the whole cloud, or null to search
/// \param rounds how often the rule is applied
RecomputationReport recomputeCloudNormals(const PointView& points,
                                          const std::vector<pcl::index_t>& indices,
                                          const Neighborhoods* neighborhoods,
                                          const std::vector<std::uint8_t>& regular,
                                          const RecomputationOptions& options, int rounds,
                                          std::vector<std::int32_t>& labels,
                                          std::vector<float>& normals);

}  // namespace segorient
