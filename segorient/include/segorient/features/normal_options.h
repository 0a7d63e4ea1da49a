// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace segorient {

/// How a normal is found from a neighbourhood (paper, section 2.2).
enum class NormalEstimator {
  PLANE,           ///< least-squares plane of the neighbours and the point
  LCT,             ///< local centre triangulation: area-weighted fan around the centre of mass
  LDT,             ///< local Delaunay triangulation: unit-weighted star of the point
  AWAS_QUADRATIC,  ///< approximation with an analytic surface: z = f(x, y) with 6 coefficients
  AWAS_CUBIC,      ///< the same with 10; where they are not determined, the quadratic one
  /// Chosen point by point from the cloud itself, by its noise and its bends. Only whole clouds are
  /// estimated so; what takes one neighbourhood at a time takes it for PLANE.
  AUTO,

  // As version 1.0 had them.
  Plane [[deprecated("PLANE")]] = PLANE,
  AwASQuadratic [[deprecated("AWAS_QUADRATIC")]] = AWAS_QUADRATIC,
  AwASCubic [[deprecated("AWAS_CUBIC")]] = AWAS_CUBIC,
  Automatic [[deprecated("AUTO")]] = AUTO
};

/// Curvatures of the fitted surface at the point, by pcl::PrincipalCurvatures' conventions:
/// direction of the larger one, then both, |pc1| >= |pc2|. Signs are those of the surface seen
/// along the normal: positive where it bends towards the normal. NaN where no surface was fitted.
struct LocalCurvature {
  float direction[3];
  float pc1;
  float pc2;
};

/// How normals are estimated.
struct NormalSettings {
  NormalEstimator estimator = NormalEstimator::PLANE;
  /// Where AwAS starts from: PLANE, LCT or LDT; others mean PLANE.
  NormalEstimator first_guess = NormalEstimator::PLANE;
};

/// What to estimate, and from how many neighbours.
struct LocalNormalOptions : NormalSettings {
  /// Neighbours of each row to use beside its first entry (the point itself); <= 0 = all.
  int k = 0;
  int threads = 0;  ///< 0 = all cores; no result depends on it
  bool portable =
      false;  ///< do without wide vector instructions; the result is the same to the bit
};

/// How normals near sharp edges are found again once there are segments (paper, section 2.3.1).
enum class RecomputationRule {
  /// For each segment around a point a quadratic surface through that segment's points only; the
  /// point joins the segment whose surface passes nearest to it, and takes the surface's normal.
  ONE_SIDED,
  /// The paper's: neighbours in segments beyond a sharp edge are replaced by others, and the normal
  /// is estimated anew from the modified neighbourhood. Labels stay.
  MODIFIED_NEIGHBORHOODS,

  // As version 1.0 had them.
  OneSided [[deprecated("ONE_SIDED")]] = ONE_SIDED,
  ModifiedNeighborhoods [[deprecated("MODIFIED_NEIGHBORHOODS")]] = MODIFIED_NEIGHBORHOODS
};

/// How normals are recomputed. Angles in radians.
struct RecomputationSettings {
  RecomputationRule rule = RecomputationRule::ONE_SIDED;
  /// ONE_SIDED: a border is sharp for a point if the surfaces of its two sides meet there at this
  /// angle or more (20 degrees).
  float edge_angle = 0.3490659F;
  /// MODIFIED_NEIGHBORHOODS: a border is sharp if the normals across it differ by this on average
  /// (delta, 30 degrees). Less than the edge's own angle: both sides' normals have been averaged
  /// over the edge.
  float delta = 0.5235988F;
  /// MODIFIED_NEIGHBORHOODS: measure delta between the segments' reference normals, as the paper
  /// does, instead of between neighbouring points across the border. Smooth borders between grown
  /// segments then count as sharp wherever beta exceeds delta.
  bool delta_between_references = false;
};

/// The same for a table of neighbours that is there.
struct RecomputationOptions : RecomputationSettings {
  /// MODIFIED_NEIGHBORHOODS: how normals are estimated from the modified neighbourhoods.
  NormalEstimator estimator = NormalEstimator::PLANE;
  int k = 0;        ///< neighbours of each row to use beside the point itself; <= 0 = all
  int threads = 0;  ///< 0 = all cores; no result depends on it
};

struct RecomputationReport {
  std::size_t examined = 0;    ///< points with a border in their neighbourhood
  std::size_t recomputed = 0;  ///< points with a new normal
  std::size_t moved = 0;       ///< points with a new label
};

}  // namespace segorient
