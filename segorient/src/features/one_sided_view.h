// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "features/one_sided_patch.h"
#include "features/recompute_scene.h"

namespace segorient::detail {

/// Two segments near a point, and whether it saw a sharp edge between them.
struct SeenBorder {
  std::pair<std::int32_t, std::int32_t> labels;
  bool sharp = false;
};

/// What a point looked at by itself would have.
struct Proposal {
  Recomputed result;  ///< accepted: it sees a sharp edge
  /// To the surface that it joins, as it would pass without the point itself.
  double off = std::numeric_limits<double>::infinity();
  double to_other_face = std::numeric_limits<double>::infinity();  ///< in spacings
  std::vector<SeenBorder> borders;
};

/// The sides near a point, and the one that it most likely belongs to.
class OneSidedView {
 public:
  OneSidedView(const RecomputationScene& scene, const RecomputationOptions& options,
               OneSidedNormal which);

  void buildPatch(std::size_t middle);

  /// Proposes a side for a point on the patch.
  void propose(std::size_t i, Proposal& proposal);

 private:
  using Side = OneSidedPatch::Side;

  /// One side as the point sees it.
  struct SeenSide {
    const Side* side;
    SurfaceView view;
    double sigma;      ///< standard deviation of the point's height over the surface; never zero
    double center[3];  ///< of the side's points, from the point
  };

  static double cosine(const SeenSide& a, const SeenSide& b);
  bool touches(std::size_t i, std::int32_t label) const;
  void lookAtSides(std::size_t i);
  bool oneSurfaceFitsWorse(const OneSidedFit& best);
  const SeenSide* mostLikelySide() const;
  /// Negative logarithm of the likelihood that the point belongs to the side: that noise put it so
  /// far off this surface, and that it lies on that side of every other surface where this
  /// segment's points lie. The latter settles what distances alone leave open near the edge itself.
  double unlikelihood(const SeenSide& side) const;
  /// The mean of the sides' normals by the likelihoods, each turned as its own points are.
  void setExpected(float* normal) const;
  double distanceToOtherFace(const SeenSide& own) const;
  void noteBorders(const SeenSide& best, Proposal& proposal) const;

  const RecomputationScene& scene_;
  OneSidedPatch patch_;
  OneSidedNormal which_;
  double edge_cosine_;
  std::size_t middle_ = 0;
  std::vector<SeenSide> sides_;
};

}  // namespace segorient::detail
