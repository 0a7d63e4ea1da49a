// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/plan_sensors.h"

#include <algorithm>
#include <limits>

namespace segorient::program {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

}  // namespace

PlanSensors::PlanSensors(const Plan& plan, const PointSample& sample, std::size_t image_width,
                         int threads) {
  const bool known = plan.has_viewpoint || plan.has_viewpoints || plan.up;
  if (known || !plan.find_sensors || plan.closed) return;
  by_row_ = plan.rows <= kSamplePoints;
  const std::size_t size = by_row_ ? static_cast<std::size_t>(plan.rows) : sample.places().size();
  points_.assign(3 * size, kNaN);
  for (std::size_t i = 0; i < sample.places().size(); ++i) {
    const std::size_t to = by_row_ ? static_cast<std::size_t>(sample.rows()[i]) : i;
    for (std::size_t a = 0; a < 3; ++a) {
      points_[3 * to + a] = static_cast<float>(sample.places()[i][a] - plan.origin[a]);
    }
  }
  SensorOptions options;
  options.threads = threads;
  options.image_width = by_row_ ? image_width : 0;
  for (std::size_t a = 0; a < 3; ++a) {
    options.suggestions[0][a] = static_cast<float>(-plan.origin[a]);
  }
  const PointView points{points_.data(), 3, size};
  report_ = findSensors(points, options);
  if (!report_.sure()) return;
  sure_ = static_cast<std::size_t>(std::count_if(report_.sensors.begin(), report_.sensors.end(),
                                                 [](const FoundSensor& s) { return s.sure; }));
  if (by_row_) return;
  search::MedianHashIndex::Options search_options;
  search_options.threads = threads;
  index_.build(points, nullptr, search_options);
}

std::array<float, 3> PlanSensors::of(std::uint64_t row, const std::array<float, 3>& place) const {
  pcl::index_t point = static_cast<pcl::index_t>(by_row_ ? row : 0);
  float distance = 0.F;
  if (!by_row_ && index_.nearestK(place.data(), 1, &point, &distance) == 0) point = 0;
  const std::int32_t sensor = report_.sensor_of[static_cast<std::size_t>(point)];
  if (sensor < 0 || !report_.sensors[static_cast<std::size_t>(sensor)].sure) {
    return {kNaN, kNaN, kNaN};
  }
  return report_.sensors[static_cast<std::size_t>(sensor)].position;
}

}  // namespace segorient::program
