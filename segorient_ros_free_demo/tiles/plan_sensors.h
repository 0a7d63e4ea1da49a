// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "orientation/sensors/sensor_hints.h"
#include "tiles/plan.h"
#include "tiles/point_sample.h"

namespace segorient::program {

/// Where some points of a cloud say that they were seen from.
class PlacesSaid {
 public:
  using Place = TileTree::Place;
  /// \param point that is said to have been seen from `p`
  void add(const Place& p, const Place& point) {
    const bool known = detail::saysPlace(p.data(), point.data());
    if (!first_) first_ = p;
    one_ = one_ && known && p == *first_;
    ++points_;
    if (known) ++known_;
  }
  bool none() const { return known_ == 0; }
  /// Whether more than a hundredth of them do not know it.
  bool partly() const { return known_ > 0 && 100 * (points_ - known_) > points_; }
  /// The place, if it is one for all of them.
  std::optional<Place> one() const { return one_ && !none() ? first_ : std::nullopt; }

 private:
  std::optional<Place> first_;
  bool one_ = true;
  std::size_t points_ = 0;
  std::size_t known_ = 0;
};

/// Where the points of a cloud were seen from, by a sample of all of it, as choosePlaces() decides
/// of a cloud in memory. A thinner cloud has the same ratios of densities, from which sensors are
/// found, and the same shadows.
class PlanSensors {
 public:
  /// Looks for sensors unless some are known, and whether to believe in one place for all points.
  /// \param said by the points of the sample
  /// \param image_width see SensorOptions; 0 unless the sample is one whole range image
  PlanSensors(const Plan& plan, const PointSample& sample, const PlacesSaid& said,
              std::size_t image_width, int threads);

  /// Whether the places that are given are followed.
  bool followsGiven() const { return follows_given_; }
  /// Whether what is far above did not see the surface.
  bool refusesUp() const { return refuses_up_; }
  /// What is known of the one that is followed.
  const CloudPlace& place() const { return place_; }
  std::size_t found() const { return sure_; }
  /// Whether what is found is for points that do not know their own place.
  bool completesGiven() const { return completes_given_; }
  /// Where a point was seen from, relative to the plan's origin; NaN where no sensor is sure.
  std::array<float, 3> of(std::uint64_t row, const std::array<float, 3>& place) const;
  /// Where the scene was seen from within: the mean direction to where; 0 = unknown.
  std::array<float, 3> directionOf(std::uint64_t row, const std::array<float, 3>& place) const;

 private:
  void takeSample(const Plan& plan, const PointSample& sample);
  std::vector<std::size_t> somePoints() const;
  PipelineReport orientSome(const OrientationHints& given, int threads) const;
  bool heeds(const OrientationHints& given, int threads) const;
  bool seeBothSides(int threads) const;
  void choose(const OrientationHints& given, int threads);
  std::array<float, 3> placeOf(std::size_t point) const;  // of the sample
  std::size_t sampleOf(std::uint64_t row, const std::array<float, 3>& place) const;

  SensorReport report_;
  std::vector<float> directions_;  // 3 a point of the sample, or empty
  CloudPlace place_;
  bool follows_given_ = true;
  bool refuses_up_ = false;
  bool completes_given_ = false;
  std::size_t sure_ = 0;
  bool by_row_ = false;        // the sample is all there is
  std::vector<float> points_;  // 3 each
  search::MedianHashIndex index_;
};

}  // namespace segorient::program
