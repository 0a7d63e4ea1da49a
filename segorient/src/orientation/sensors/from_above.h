// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>

#include <optional>

#include "orientation/sensors/density_patches.h"
#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/height_field.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {

/// What there is of a cloud that somebody far above it can have seen, each looked for once and only
/// if somebody asks.
class FromAbove {
 public:
  /// All must outlive this.
  /// \param patches of the cloud
  /// \param flat the cloud's points on surfaces
  FromAbove(PreparedCloud& cloud, const DensityPatches& patches, FlatPointsOnce& flat, int threads)
      : cloud_(cloud), patches_(patches), flat_(flat), threads_(threads) {}

  /// The cloud as one surface over the ground.
  const HeightField& field();

  FlatPointsOnce& flat() { return flat_; }

  /// Puts a sensor far above into the report if the cloud is woods as lasers see them from the air:
  /// beams pass between the leaves, so that points lie at all heights and on no surface, and below
  /// them is the ground. Such a cloud closes as a body does, but what is on surfaces in it is one
  /// surface that all the rest lies above.
  /// \param report has one entry a point
  void lookOverWoods(SensorReport& report);

  /// The same if the cloud, whose density varies, is one surface over the ground, or woods.
  void look(SensorReport& report);

 private:
  PreparedCloud& cloud_;
  const DensityPatches& patches_;
  FlatPointsOnce& flat_;
  int threads_;
  std::optional<HeightField> field_;
  bool asked_for_woods_ = false;
  std::optional<HeightField> under_woods_;  ///< the ground of those, if it is that
};

}  // namespace segorient::detail
