// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/place_choice.h"

#include <algorithm>
#include <array>
#include <utility>

#include "orientation/sensors/found_sensor.h"
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

// By distinct point; of rows that repeat one, any.
std::vector<std::uint8_t> ofPoints(const std::vector<std::uint8_t>& flags,
                                   const PreparedCloud& cloud) {
  std::vector<std::uint8_t> out(flags.empty() ? 0 : cloud.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = flags[cloud.rowOf(i)];
  return out;
}

void dropSuggestion(CloudPlace& place) {
  place.may_be_suggested = false;
  place.suggestion_suits = false;
}

// What a search finds is followed as if it had been given.
PlaceChoice findOthers(const PointView& points, OrientationHints hints, PreparedCloud& cloud,
                       int threads, SeenShadows seen = {}) {
  PlaceChoice out;
  out.sensors = addFoundSensors(points, cloud, threads, hints, seen);
  // What one layer or woods told is not to be told by others again, which know nothing of trees.
  out.place.found = isOverGround(out.sensors);
  out.place.along_way = out.sensors.sure() && out.sensors.sensors[0].kind == SensorKind::MOVING;
  out.either_side = ofPoints(out.sensors.either_side, cloud);
  // Whoever names a side of a sheet means it.
  if (out.sensors.faces_up && !hints.seeds.empty()) {
    out.sensors.faces_up = false;
    out.sensors.why += ", unless seeds say otherwise";
  }
  out.place.faces_up = out.sensors.faces_up;
  out.place.seen_within = !hints.normals.empty();
  const bool found = out.sensors.sure() || out.place.faces_up || out.place.seen_within;
  const bool may_be_suggested = !hints.suggested.empty() && !seen.of_first.deny();
  out.place.may_be_suggested = !found && may_be_suggested;
  out.place.suggestion_suits = seen.of_first.suit();
  if (seen.in_a_room) {
    out.if_no_room = out.place;
    out.if_no_room->seen_within = false;
    out.if_no_room->may_be_suggested = may_be_suggested;
  }
  if (out.sensors.sensors.empty()) out.sensors.sensor_of = {};
  out.hints = std::move(hints);
  out.place.shadows = seen.of_sensor;
  out.place.whole_image = seen.whole_image;
  return out;
}

}  // namespace

PlaceChoice choosePlaces(const PointView& points, const OrientationHints& given, bool find_sensors,
                         PreparedCloud& cloud, int threads) {
  const std::optional<std::array<float, 3>> place = onlyPlace(given, points.size);
  OrientationHints others = place ? withoutPlaces(given) : given;
  if (!find_sensors || !lacksSensors(others)) return {};
  if (!place || !isFinite(place->data())) {
    PlaceChoice found = findOthers(points, std::move(others), cloud, threads);
    if (place) found.refused = refusedPlace(*place, cloud);
    return found;
  }
  PlaceChoice as_given;
  SeenShadows seen;
  if (!isImage(given, points.size)) {
    as_given.place.shadows = findShadows(cloud.points(), cloud.inUnit(*place), threads);
    // What does not confirm a place reveals none.
    seen.nothing_at = place;
  }
  if (as_given.place.shadows.confirm()) return as_given;
  others.suggested.push_back(*place);
  PlaceChoice found = findOthers(points, std::move(others), cloud, threads, seen);
  // What only shadows tell of turns nobody away whom they do not deny.
  const bool by_shadows = found.sensors.sure() &&
                          found.sensors.sensors[0].evidence == SensorEvidence::SHADOWS &&
                          !as_given.place.shadows.deny();
  if (!by_shadows && contradictsPlace(cloud, found.sensors, *place)) {
    found.refused = refusedPlace(*place, cloud);
    return found;
  }
  as_given.place.found = found.sensors.sure() && !found.sensors.sensors[0].suggested;
  const bool is_fact = as_given.place.found || !given.viewpoints.empty();
  if (is_fact || !as_given.place.shadows.deny()) return as_given;
  // What was found in that very place is no more than compared, either.
  if (found.sensors.sure()) found = findOthers(points, asIfNotThere(given, *place), cloud, threads);
  // Nor is it as good as any.
  dropSuggestion(found.place);
  if (found.if_no_room) dropSuggestion(*found.if_no_room);
  found.hiding = lookFrom(cloud.points(), cloud.inUnit(*place), threads);
  return found;
}

}  // namespace segorient::detail
