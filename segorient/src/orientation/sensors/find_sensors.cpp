// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/in_double.h"
#include "common/unit_vector.h"
#include "orientation/sensors/camera_views.h"
#include "orientation/sensors/density_search.h"
#include "orientation/sensors/found_sensor.h"
#include "orientation/sensors/image_rays.h"
#include "orientation/sensors/room_shadows.h"
#include "orientation/sensors/sensor_search.h"
#include "orientation/sensors/shadows.h"
#include "orientation/sensors/station_search.h"

namespace segorient {

using detail::CameraViews;
using detail::RevealedPlace;
using detail::setOnly;

namespace {

// A place in the cloud's unit that shadows reveal, or do not deny where a whole image tells of it.
void setRevealed(const RevealedPlace& revealed, const char* why, detail::SeenShadows& seen,
                 SensorReport& out) {
  seen.of_sensor = revealed.shadows;
  seen.whole_image = revealed.whole_image;
  FoundSensor sensor;
  sensor.evidence = SensorEvidence::SHADOWS;
  sensor.position = revealed.place;
  sensor.cost_ratio = revealed.shadows.coveredOfSteps();
  sensor.sure = true;
  out.directions.clear();
  out.faces_up = false;
  setOnly(sensor, why, out);
}

// The first of the suggestions that they reveal.
std::optional<RevealedPlace> trySuggestedShadows(const PreparedCloud& cloud,
                                                 const SensorOptions& options, CameraViews& views,
                                                 detail::SeenShadows& seen) {
  for (const std::array<float, 3>& suggestion : options.suggestions) {
    if (suggestion == seen.nothing_at) continue;
    const std::array<float, 3> s = cloud.inUnit(suggestion);
    const detail::Shadows shadows = detail::findShadows(views.flat(), s, options.threads, true);
    if (shadows.reveal()) return RevealedPlace{s, shadows};
    if (&suggestion == &options.suggestions.front()) seen.of_first = shadows;
  }
  return std::nullopt;
}

// Whether far fewer points go on behind shadows of a camera than behind those of a suggested place.
bool hidesFarLess(const std::vector<RevealedPlace>& cameras, const RevealedPlace& suggested) {
  return !cameras.empty() && cameras.front().shadows.coveredOfSteps() <
                                 detail::kMuchBetter * suggested.shadows.coveredOfSteps();
}

// A camera looks at the middle of the cloud.
void setCamera(const detail::FlatPoints& flat, FoundSensor& sensor) {
  const std::array<float, 3> middle = flat.middle();
  std::array<double, 3> gaze{};
  for (std::size_t a = 0; a < 3; ++a) {
    gaze[a] = static_cast<double>(middle[a]) - static_cast<double>(sensor.position[a]);
  }
  sensor.kind = SensorKind::CAMERA;
  unitVector(gaze, sensor.axis.data());
}

// Thinned clouds have lost their densities, which leaves who hides whom. That there is one layer
// over the ground says less.
void lookForShadows(const PreparedCloud& cloud, const SensorOptions& options, CameraViews& views,
                    detail::SeenShadows& seen, SensorReport& out) {
  if (out.sure() && out.sensors[0].kind != SensorKind::ABOVE) return;
  const std::optional<RevealedPlace> suggested = trySuggestedShadows(cloud, options, views, seen);
  const bool knows = out.sure() || out.faces_up || !out.directions.empty();
  const bool asks = options.search && (suggested || !knows);
  const std::vector<RevealedPlace> none;
  const std::vector<RevealedPlace>& cameras = asks ? views.cameras() : none;
  if (suggested && !hidesFarLess(cameras, *suggested)) {
    setRevealed(*suggested, "surfaces end at the shadows that the suggested place casts", seen,
                out);
    out.sensors[0].suggested = true;
  } else if (!cameras.empty()) {
    setRevealed(cameras.front(), "the sides of an image meet where surfaces end at the shadows",
                seen, out);
    setCamera(views.flat(), out.sensors[0]);
  } else if (asks) {
    out.directions = detail::directionsInARoom(cloud.points(), views.flat(), options.threads);
    seen.in_a_room = !out.directions.empty();
    if (seen.in_a_room) out.why += ", but surfaces end at shadows as seen from within";
  }
}

// The suggestion that is in that place, as far as its sides tell.
std::optional<std::array<float, 3>> suggestedAt(
    const std::array<float, 3>& place, const std::vector<std::array<float, 3>>& suggestions,
    const std::array<float, 3>& middle) {
  constexpr double kSamePlace = 0.05;  // of the distance
  const std::array<double, 3> apex = inDouble(place.data());
  const double reach = kSamePlace * detail::distance(apex, inDouble(middle.data()));
  for (const std::array<float, 3>& s : suggestions) {
    if (detail::distance(apex, inDouble(s.data())) < reach) return s;
  }
  return std::nullopt;
}

// In the unit of the cloud. All four sides of an image tell of its camera unless shadows deny it.
// Where that is a suggestion, densities are asked first, as they say more of it.
SensorReport searchPositions(PreparedCloud& cloud, const SensorOptions& options,
                             detail::SeenShadows& seen) {
  SensorOptions scaled = options;
  for (std::array<float, 3>& s : scaled.suggestions) s = cloud.inUnit(s);
  CameraViews views(cloud, options.threads);
  std::optional<RevealedPlace> whole;
  if (options.search && !views.cameras().empty() && views.cameras().front().whole_image) {
    whole = views.cameras().front();
  }
  std::optional<std::array<float, 3>> suggested;
  if (whole) suggested = suggestedAt(whole->place, scaled.suggestions, views.flat().middle());
  SensorReport out;
  if (!whole || suggested) {
    out = detail::searchByDensity(cloud, scaled, views);
    if (!whole) lookForShadows(cloud, options, views, seen, out);
    if (!whole || out.sure()) return out;
    whole->place = *suggested;
  }
  out.sensor_of.assign(cloud.size(), 0);
  setRevealed(*whole, "the sides of an image meet in one place", seen, out);
  setCamera(views.flat(), out.sensors[0]);
  out.sensors[0].suggested = suggested.has_value();
  return out;
}

}  // namespace

SensorReport detail::sensorsOf(const PointView& points, PreparedCloud& cloud,
                               const SensorOptions& options, SeenShadows& shadows) {
  SensorReport out;
  std::optional<FoundSensor> camera;
  if (options.image_width > 0) camera = cameraOfImage(points, options.image_width);
  if (camera) {
    out.sensor_of.resize(cloud.size());
    setOnly(*camera, "the rays of the image meet in one place", out);
  } else {
    out = searchPositions(cloud, options, shadows);
    for (FoundSensor& s : out.sensors) {
      for (float& v : s.position) v *= cloud.unit();
    }
  }
  out.sensor_of = cloud.scatter(out.sensor_of, 1, std::int32_t{-1});
  if (!out.either_side.empty())
    out.either_side = cloud.scatter(out.either_side, 1, std::uint8_t{0});
  if (!out.directions.empty()) out.directions = cloud.scatter(out.directions, 3, 0.F);
  for (FoundSensor& s : out.sensors) s.points = 0;
  for (const std::int32_t s : out.sensor_of) {
    if (s >= 0) ++out.sensors[static_cast<std::size_t>(s)].points;
  }
  return out;
}

bool SensorReport::sure() const {
  return std::any_of(sensors.begin(), sensors.end(), [](const FoundSensor& s) { return s.sure; });
}

SensorReport findSensors(const PointView& points, const SensorOptions& options) {
  PreparedCloud cloud(points, nullptr, options.threads);
  detail::SeenShadows shadows;
  return detail::sensorsOf(points, cloud, options, shadows);
}

}  // namespace segorient
