// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/sensors.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tiles/plan.h"
#include "tiles/point_sample.h"

namespace segorient::program {

/// Sensors that nobody named, found in a sample of the whole cloud: where each of its points was
/// seen from. A thinner cloud has the same ratios of densities, from which they are found.
class PlanSensors {
 public:
  /// Looks for them, unless the plan knows some.
  /// \param image_width see SensorOptions; 0 unless the sample is one whole range image
  PlanSensors(const Plan& plan, const PointSample& sample, std::size_t image_width, int threads);

  std::size_t found() const { return sure_; }
  /// Where a point was seen from, relative to the plan's origin; NaN where no sensor is sure.
  std::array<float, 3> of(std::uint64_t row, const std::array<float, 3>& place) const;

 private:
  SensorReport report_;
  std::size_t sure_ = 0;
  bool by_row_ = false;        // the sample is all there is
  std::vector<float> points_;  // 3 each
  search::MedianHashIndex index_;
};

}  // namespace segorient::program
