// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/orientation/orientation_hints.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/sensors/shadows.h"
#include "search/prepared_cloud.h"

namespace segorient {

/// What the whole cloud says of the one place that all of its points are said to have been seen
/// from, or of those that were found.
struct CloudPlace {
  detail::Shadows shadows;  ///< what steps of depth say of it; no steps where nobody looked
  /// Whether a search for sensors came to it, too, by itself, or found it by layers, which is told
  /// about trees already.
  bool found = false;
  /// Whether nobody knows a place, but all of it is one surface over the ground, see SensorReport.
  bool faces_up = false;
  /// Whether all four sides of an image meet in it.
  bool whole_image = false;
  /// Whether a search found places along a sensor's way, which are near the true ones only: what
  /// is hidden from them, and how dense their own points are, says little.
  bool along_way = false;
  /// Whether a search found no place, but that all was seen from within: each point's direction is
  /// then that to where it was seen from.
  bool seen_within = false;
  /// Whether a search found nothing at all, so that the suggested place is as good as any, unless
  /// shadows deny it.
  bool may_be_suggested = false;
  bool suggestion_suits = false;  ///< see SeenShadows::of_first
};

/// OrientationHints by distinct point, in the unit of a PreparedCloud.
struct PointHints {
  struct Seed {
    std::size_t point = 0;
    std::array<float, 3> normal{0.F, 0.F, 0.F};  ///< unit length
  };

  SurfaceKind surface = SurfaceKind::UNKNOWN;
  bool has_viewpoint = false;
  std::array<float, 3> viewpoint{0.F, 0.F, 0.F};
  CloudPlace place;
  std::array<float, 3> suggested{0.F, 0.F, 0.F};  ///< see CloudPlace::may_be_suggested
  /// 3 floats a point: where it was seen from, NaN = unknown; empty = none
  std::vector<float> sensors;
  /// One a point: see SensorReport::either_side; empty = none
  std::vector<std::uint8_t> either_side;
  /// Whether the points are an even sample of those that were seen: density tells nothing.
  bool even_sample = false;
  /// The scan that each point is of, -1 = unknown; empty unless places are given by point.
  std::vector<std::int32_t> scans;
  /// 3 floats a point: sum of the unit vectors that its normal is said to point along; empty = none
  std::vector<float> directions;
  std::vector<Seed> seeds;
  /// 3 floats a point: unit vector to the sensor that saw it, 0 = unknown; empty unless it is
  /// already known which sensors are to be believed. Then `sensors` is empty.
  std::vector<float> toward;

  /// Whether nothing knows the side of each point, so that the field of all of them may tell it.
  bool leaveSidesToField() const {
    return surface != SurfaceKind::OPEN && !has_viewpoint && !place.faces_up &&
           !place.seen_within && sensors.empty() && toward.empty();
  }
};

/// \param cloud the one that `hints` is about
SEGORIENT_ORIENTATION_EXPORT PointHints resolveHints(const OrientationHints& hints,
                                                     PreparedCloud& cloud);

}  // namespace segorient
