// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/given_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "common/at.h"
#include "common/dot.h"
#include "common/unit_vector.h"
#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/sensor_hints.h"

namespace segorient::detail {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

bool isConfirmed(const KnownSensor& scan) {
  // Places with few points each are not looked at one by one.
  return scan.used && (scan.moving || scan.confirmed || scan.density < kConfirmed);
}

bool hasPlace(const std::vector<float>& places, std::size_t row) {
  return 3 * row + 2 < places.size() && isFinite(&places[3 * row]);
}

// Whether a place is in the direction of a sensor, as seen from a point.
bool isTowards(const float* toward, const float* place, const float* from) {
  float direction[3];
  return directionTo(from, place, direction) &&
         static_cast<double>(dot(toward, direction)) >= kSameWay;
}

}  // namespace

bool leavesDoubt(const std::vector<KnownSensor>& scans, const PreparedCloud& cloud) {
  constexpr double kFewUnknown = 0.01;  // of the points: what strays may be
  std::size_t followed = 0;
  for (const KnownSensor& scan : scans) {
    if (!isConfirmed(scan)) return true;
    followed += scan.seen;
  }
  const auto points = static_cast<double>(cloud.size());
  return static_cast<double>(followed) < (1.0 - kFewUnknown) * points;
}

std::optional<OrientationHints> completePlaces(const OrientationHints& given,
                                               const OrientationHints& found,
                                               const std::vector<std::uint8_t>& either_side,
                                               const PreparedCloud& cloud, const SeenPoints& seen,
                                               std::vector<KnownSensor>& scans) {
  std::vector<std::size_t> elsewhere(scans.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::size_t row = cloud.rowOf(i);
    if (seen.sensor_of[i] < 0 || !hasPlace(found.viewpoints, row)) continue;
    const std::array<float, 3> place = cloud.inUnit(
        {found.viewpoints[3 * row], found.viewpoints[3 * row + 1], found.viewpoints[3 * row + 2]});
    if (!isTowards(&seen.toward[3 * i], place.data(), cloud.points()[i])) {
      ++elsewhere[at(seen.sensor_of[i])];
    }
  }
  const auto isElsewhere = [&](std::size_t s) { return 2 * elsewhere[s] > scans[s].points; };
  std::size_t refuting = 0;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    if (scans[s].confirmed && isElsewhere(s)) refuting += scans[s].points;
  }
  if (2 * refuting > cloud.size()) return std::nullopt;
  const bool mixed_up =
      std::any_of(scans.begin(), scans.end(), [](const KnownSensor& s) { return !s.used; });
  for (std::size_t s = 0; s < scans.size(); ++s) {
    if (scans[s].used && (mixed_up || !isConfirmed(scans[s])) && isElsewhere(s)) {
      scans[s].used = false;
    }
  }
  OrientationHints out = given;
  out.viewpoints.resize(found.viewpoints.size(), kNaN);
  bool changed = false;
  for (std::size_t row = 0; row < cloud.rows(); ++row) {
    if (cloud.pointOf(row) < 0) continue;
    const std::size_t point = at(cloud.pointOf(row));
    const std::int32_t scan = seen.sensor_of[point];
    if (scan >= 0 && scans[at(scan)].used) continue;
    float* const place = &out.viewpoints[3 * row];
    std::copy_n(&found.viewpoints[3 * row], 3, place);
    if (!either_side.empty() && either_side[point] != 0) std::fill_n(place, 3, kNaN);
    changed = changed || isFinite(place);
  }
  return changed ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace segorient::detail
