// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/sensor_hints.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "common/dot.h"
#include "common/every_nth.h"
#include "common/unit_vector.h"

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

bool saysPlaces(const OrientationHints& hints) {
  return hints.has_viewpoint || !hints.viewpoints.empty();
}

bool saysSensors(const OrientationHints& hints) {
  return saysPlaces(hints) || hints.has_direction;
}

bool lacksSensors(const OrientationHints& hints) {
  return !saysSensors(hints) && hints.normals.empty() && hints.surface != SurfaceKind::CLOSED;
}

bool isImage(const OrientationHints& hints, std::size_t rows) {
  return hints.grids.size() == 1 && hints.grids[0].first == 0 &&
         hints.grids[0].width * hints.grids[0].height == rows;
}

SensorReport addFoundSensors(const PointView& points, PreparedCloud& cloud, int threads,
                             OrientationHints& hints, SeenShadows& shadows) {
  SensorOptions options;
  options.threads = threads;
  options.suggestions = hints.suggested;
  // One image that is the whole cloud has a camera of its own; of several, each would be looked
  // for.
  if (isImage(hints, points.size)) options.image_width = hints.grids[0].width;
  SensorReport report = sensorsOf(points, cloud, options, shadows);
  if (report.sure()) addViewpoints(report, hints);
  hints.normals = std::move(report.directions);
  report.directions.clear();
  return report;
}

OrientationHints withoutPlaces(const OrientationHints& hints) {
  OrientationHints out = hints;
  out.has_viewpoint = false;
  out.viewpoints.clear();
  return out;
}

OrientationHints withoutSensors(const OrientationHints& hints) {
  OrientationHints out = withoutPlaces(hints);
  out.has_direction = false;
  return out;
}

std::optional<std::array<float, 3>> onlyPlace(const OrientationHints& hints, std::size_t rows) {
  if (hints.viewpoints.empty()) {
    return hints.has_viewpoint ? std::optional(hints.viewpoint) : std::nullopt;
  }
  const std::vector<float>& v = hints.viewpoints;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!std::isfinite(v[i]) || v[i] != v[i % 3]) return std::nullopt;
  }
  const bool all = v.size() >= 3 * std::max<std::size_t>(1, rows);
  return all ? std::optional(std::array<float, 3>{v[0], v[1], v[2]}) : std::nullopt;
}

bool contradictsPlace(const PreparedCloud& cloud, const SensorReport& report,
                      const std::array<float, 3>& place) {
  constexpr std::size_t kSample = 1000;  // a mean of so many is sure to a hundredth
  if (!report.sure()) return false;
  std::vector<std::array<float, 3>> found;
  for (const FoundSensor& s : report.sensors) found.push_back(cloud.inUnit(s.position));
  const std::array<float, 3> given = cloud.inUnit(place);
  double sum = 0.0;
  std::size_t count = 0;
  const PointView points = cloud.points();
  for (const std::size_t i : EveryNth(points.size, kSample)) {
    float to_given[3];
    if (!directionTo(points[i], given.data(), to_given)) continue;
    float least = 2.F;
    for (const std::array<float, 3>& f : found) {
      float to_found[3];
      if (directionTo(points[i], f.data(), to_found)) {
        least = std::min(least, dot(to_given, to_found));
      }
    }
    if (least > 1.5F) continue;  // it is where they are
    sum += static_cast<double>(least);
    ++count;
  }
  return count > 0 && sum < kSameWay * static_cast<double>(count);
}

}  // namespace segorient::detail
