// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/sensor_hints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "orientation/sensors/sensor_search.h"

namespace segorient::detail {
namespace {

// Rows that no sure sensor has seen stay unknown.
void addViewpoints(const SensorReport& report, OrientationHints& hints) {
  hints.viewpoints.assign(3 * report.sensor_of.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < report.sensor_of.size(); ++i) {
    if (report.sensor_of[i] < 0) continue;
    const FoundSensor& sensor = report.sensors[static_cast<std::size_t>(report.sensor_of[i])];
    if (!sensor.sure) continue;
    for (std::size_t a = 0; a < 3; ++a) hints.viewpoints[3 * i + a] = sensor.position[a];
  }
}

}  // namespace

bool lacksSensors(const OrientationHints& hints) {
  // A column of unknown places says no more than none.
  const bool any = std::any_of(hints.viewpoints.begin(), hints.viewpoints.end(),
                               [](float v) { return std::isfinite(v); });
  return !hints.has_viewpoint && !hints.has_direction && !any && hints.normals.empty() &&
         hints.surface != SurfaceKind::CLOSED;
}

SensorReport addFoundSensors(const PointView& points, PreparedCloud& cloud, int threads,
                             OrientationHints& hints) {
  SensorOptions options;
  options.threads = threads;
  options.suggestions = hints.suggested;
  // One image that is the whole cloud has a camera of its own; of several, each would be looked
  // for.
  const bool whole = hints.grids.size() == 1 && hints.grids[0].first == 0 &&
                     hints.grids[0].width * hints.grids[0].height == points.size;
  if (whole) options.image_width = hints.grids[0].width;
  SensorReport report = sensorsOf(points, cloud, options);
  if (report.sure()) addViewpoints(report, hints);
  return report;
}

}  // namespace segorient::detail
