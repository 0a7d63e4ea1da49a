// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/given_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "common/dot.h"
#include "common/in_double.h"
#include "common/unit_vector.h"
#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/sensor_hints.h"

namespace segorient::detail {
namespace {

bool isConfirmed(const KnownSensor& scan) {
  // Places with few points each are not looked at one by one.
  return scan.used && (scan.moving || scan.density < kConfirmed);
}

bool hasPlace(const std::vector<float>& places, std::size_t row) {
  return 3 * row + 2 < places.size() && isFinite(&places[3 * row]);
}

bool directionTo(const float* place, const float* from, float* out) {
  std::array<double, 3> v = inDouble(place);
  for (std::size_t a = 0; a < 3; ++a) v[a] -= static_cast<double>(from[a]);
  return unitVector(v, out);
}

}  // namespace

bool leavesDoubt(const std::vector<KnownSensor>& scans, const PreparedCloud& cloud) {
  constexpr double kFewUnknown = 0.01;
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
                                               const PreparedCloud& cloud,
                                               const std::vector<std::int32_t>& scan_of,
                                               std::vector<KnownSensor>& scans) {
  std::vector<std::size_t> both(scans.size(), 0);
  std::vector<std::size_t> same(scans.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::size_t row = cloud.rowOf(i);
    if (scan_of[i] < 0 || !hasPlace(given.viewpoints, row) || !hasPlace(found.viewpoints, row)) {
      continue;
    }
    const std::array<float, 3> from{cloud.unit() * cloud.points()[i][0],
                                    cloud.unit() * cloud.points()[i][1],
                                    cloud.unit() * cloud.points()[i][2]};
    float a[3];
    float b[3];
    if (!directionTo(&given.viewpoints[3 * row], from.data(), a) ||
        !directionTo(&found.viewpoints[3 * row], from.data(), b)) {
      continue;
    }
    ++both[static_cast<std::size_t>(scan_of[i])];
    if (dot(a, b) >= kSameWay) ++same[static_cast<std::size_t>(scan_of[i])];
  }
  const bool mixed_up =
      std::any_of(scans.begin(), scans.end(), [](const KnownSensor& s) { return !s.used; });
  for (std::size_t s = 0; s < scans.size(); ++s) {
    if (scans[s].used && (mixed_up || !isConfirmed(scans[s])) && 2 * same[s] < both[s]) {
      scans[s].used = false;
    }
  }
  OrientationHints out = given;
  out.viewpoints.resize(found.viewpoints.size(), std::numeric_limits<float>::quiet_NaN());
  bool changed = false;
  for (std::size_t row = 0; row < cloud.rows(); ++row) {
    if (cloud.pointOf(row) < 0) continue;
    const std::int32_t scan = scan_of[static_cast<std::size_t>(cloud.pointOf(row))];
    if (scan >= 0 && scans[static_cast<std::size_t>(scan)].used) continue;
    std::copy_n(&found.viewpoints[3 * row], 3, &out.viewpoints[3 * row]);
    changed = changed || isFinite(&found.viewpoints[3 * row]);
  }
  return changed ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace segorient::detail
