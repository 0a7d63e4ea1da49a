// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/place_choice.h"

#include <algorithm>
#include <array>
#include <utility>

#include "orientation/sensors/sensor_hints.h"

namespace segorient::detail {
namespace {

// One place for all points that nothing was turned to.
KnownSensor refusedPlace(const std::array<float, 3>& place, const PreparedCloud& cloud) {
  KnownSensor out;
  out.position = cloud.inUnit(place);
  out.points = cloud.size();
  out.used = false;
  return out;
}

// As if no place had been given, and nobody had thought of that one.
OrientationHints asIfNotThere(const OrientationHints& given, const std::array<float, 3>& place) {
  OrientationHints hints = withoutPlaces(given);
  auto& suggested = hints.suggested;
  suggested.erase(std::remove(suggested.begin(), suggested.end(), place), suggested.end());
  return hints;
}

}  // namespace

PlaceChoice choosePlaces(const PointView& points, const OrientationHints& given, bool find_sensors,
                         PreparedCloud& cloud, int threads) {
  PlaceChoice out;
  const std::optional<std::array<float, 3>> place = onlyPlace(given, points.size);
  OrientationHints found = place ? withoutPlaces(given) : given;
  if (!find_sensors || !lacksSensors(found)) return out;
  const bool is_place = place && isFinite(place->data());
  Shadows shadows;
  SeenShadows seen;
  if (is_place && !isImage(given, points.size)) {
    shadows = findShadows(cloud.points(), cloud.inUnit(*place), threads);
    // What does not confirm a place reveals none.
    seen.nothing_at = place;
  }
  if (shadows.confirm()) {
    out.shadows = shadows;
    return out;
  }
  if (is_place) found.suggested.push_back(*place);
  SensorReport sensors = addFoundSensors(points, cloud, threads, found, seen);
  if (is_place && !contradictsPlace(cloud, sensors, *place)) {
    out.shadows = shadows;
    out.place_found = sensors.sure() && !sensors.sensors[0].suggested;
    const bool is_fact = out.place_found || !given.viewpoints.empty();
    if (is_fact || given.surface == SurfaceKind::OPEN || !shadows.deny()) return out;
    HidingPlace hiding = lookFrom(cloud.points(), cloud.inUnit(*place), threads);
    // What was found in that very place is no more than compared, either.
    if (sensors.sure()) {
      OrientationHints others = asIfNotThere(given, *place);
      out = choosePlaces(points, others, find_sensors, cloud, threads);
      if (!out.hints) out.hints = std::move(others);
      out.hiding = std::move(hiding);
      return out;
    }
    out.place_found = false;
    out.hiding = std::move(hiding);
  } else if (place) {
    out.refused = refusedPlace(*place, cloud);
  }
  out.sensors = std::move(sensors);
  if (out.sensors.sensors.empty()) out.sensors.sensor_of = {};
  out.hints = std::move(found);
  out.shadows = seen.of_sensor;
  return out;
}

}  // namespace segorient::detail
