// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "features/one_sided_fit.h"
#include "features/point_set.h"
#include "features/recompute_scene.h"

namespace segorient::detail {

/// The segments near a point, a surface through each, and one through all points around. Serves
/// the points next to it as well: their neighbourhoods are nearly the same.
class OneSidedPatch {
 public:
  struct Side {
    std::int32_t label = -1;
    OneSidedFit fit;
    double toward[3] = {0, 0, 0};  ///< sum of the normals of the points that it was fitted to
  };

  explicit OneSidedPatch(const RecomputationScene& scene) : scene_(scene) {}

  void build(std::size_t middle);

  /// Regular segments whose points have a surface.
  const std::vector<Side>& sides() const { return sides_; }
  /// Through all points around, whatever their segment.
  const OneSidedFit& whole();

 private:
  struct Candidate {
    NearPoint near;
    std::size_t point;
    std::int32_t label;
  };

  void collect(std::size_t middle);
  template <typename Accept>
  void fitNearest(const Accept& accept, OneSidedFit& fit);
  void addNormals(Side& side) const;

  const RecomputationScene& scene_;
  PointSet seen_;
  std::vector<Candidate> around_;
  std::vector<const Candidate*> chosen_;
  std::vector<NearPoint> points_;
  std::vector<Side> sides_;
  OneSidedFit whole_;
  bool whole_known_ = false;
};

}  // namespace segorient::detail
