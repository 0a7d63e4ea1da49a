// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/in_double.h"
#include "common/unit_vector.h"
#include "orientation/sensors/height_field.h"
#include "orientation/sensors/image_rays.h"
#include "orientation/sensors/joint_sensors.h"
#include "orientation/sensors/room_shadows.h"
#include "orientation/sensors/scene_frame.h"
#include "orientation/sensors/sensor_search.h"
#include "orientation/sensors/shadows.h"
#include "orientation/sensors/station_search.h"
#include "orientation/sensors/view_pyramid.h"

namespace segorient {

using detail::DensityPatches;
using detail::FittedPlace;
using detail::SamplingLaw;
using detail::toFloat;

namespace {

// Deviations of log density that are hardly more than chance have nothing to explain.
constexpr float kMoreThanChance = 1.3F;
// What a law may leave of the constant's deviation at a place that is looked at because it was
// suggested: true ones left .04 to .57, wrong ones .81 and more.
constexpr float kSureSuggested = 0.6F;
// Several sensors can adapt to much, so that there must be enough to adapt to: at twice the
// deviation of chance three quarters of the variance are something else.
constexpr float kFarBeyondChance = 2.F;
// From farther away, in diagonals, distances hardly differ, and a law is one of incidence alone.
constexpr double kFarthest = 10.0;

FoundSensor describe(const FittedPlace& fitted, float constant, bool suggested) {
  FoundSensor out;
  out.kind = fitted.place.law == SamplingLaw::PINHOLE ? SensorKind::CAMERA : SensorKind::STATION;
  out.position = toFloat(fitted.place.position);
  if (fitted.place.law != SamplingLaw::SOLID_ANGLE) out.axis = toFloat(fitted.place.axis);
  out.suggested = suggested;
  out.cost_ratio = fitted.cost / constant;
  out.sure = out.cost_ratio <= (suggested ? kSureSuggested : detail::kSureFound);
  return out;
}

// What steps of depth tell of, with what is looked for once.
class Views {
 public:
  Views(const PreparedCloud& cloud, int threads) : cloud_(cloud), threads_(threads) {}

  const detail::FlatPoints& flat() {
    if (!flat_) flat_.emplace(cloud_.points(), threads_);
    return *flat_;
  }

  struct Revealed {
    std::array<float, 3> place;
    detail::Shadows shadows;
  };
  // Where the sides of an image meet and shadows reveal a sensor, those that hide least first.
  const std::vector<Revealed>& cameras() {
    if (cameras_) return *cameras_;
    cameras_.emplace();
    for (const std::array<float, 3>& apex : detail::findApexes(flat(), threads_)) {
      const detail::Shadows shadows = detail::findShadows(flat(), apex, threads_, true);
      if (shadows.reveal()) cameras_->push_back({apex, shadows});
    }
    std::stable_sort(cameras_->begin(), cameras_->end(), [](const Revealed& a, const Revealed& b) {
      return a.shadows.coveredOfSteps() < b.shadows.coveredOfSteps();
    });
    return *cameras_;
  }

 private:
  const PreparedCloud& cloud_;
  int threads_;
  std::optional<detail::FlatPoints> flat_;
  std::optional<std::vector<Revealed>> cameras_;
};

// The suggestion that fits best, if one does.
std::optional<FittedPlace> trySuggestions(const DensityPatches& patches, float constant,
                                          const SensorOptions& options) {
  const detail::Extent extent = detail::extentOf(patches);
  std::optional<FittedPlace> best;
  for (const std::array<float, 3>& s : options.suggestions) {
    const std::array<double, 3> position = inDouble(s.data());
    if (!extent.holds(position, kFarthest * extent.diagonal())) continue;
    const FittedPlace fitted = detail::fitAt(patches, position);
    if (fitted.cost > kSureSuggested * constant) continue;
    if (!best || fitted.cost < best->cost) best = fitted;
  }
  return best;
}

// The one that saw all points.
void setOnly(const FoundSensor& sensor, const char* why, SensorReport& out) {
  out.sensors = {sensor};
  std::fill(out.sensor_of.begin(), out.sensor_of.end(), 0);
  out.why = why;
}

bool explainsFarMore(const FittedPlace& a, const FittedPlace& b, float constant) {
  return a.cost <= detail::kMuchBetter * b.cost && a.cost <= b.cost - detail::kGain * constant;
}

// From afar many places explain much. A suggested one stands unless the best of all, which has to
// be sure itself, explains far more, or more from the other side: of 58 true ones the best saw the
// same sides, of 17 that were one to five extents off it saw the others, or left .6 of what they
// did at most.
bool betters(const FittedPlace& found, const FittedPlace& suggested, float constant,
             const DensityPatches& patches) {
  if (found.cost > detail::kSureFound * constant || found.cost >= suggested.cost) return false;
  return explainsFarMore(found, suggested, constant) ||
         2 * detail::countTurned(patches, found, suggested) > patches.size();
}

// The camera that fits best, if densities are sure of one.
std::optional<FittedPlace> tryCameras(const DensityPatches& patches, float constant,
                                      const std::vector<Views::Revealed>& cameras) {
  std::optional<FittedPlace> best;
  for (const Views::Revealed& camera : cameras) {
    const FittedPlace fitted = detail::fitAt(patches, inDouble(camera.place.data()));
    if (fitted.cost > detail::kSureFound * constant) continue;
    if (!best || fitted.cost < best->cost) best = fitted;
  }
  return best;
}

// The best of all places; of those that explain about as much, a camera that the sides of an image
// and shadows tell of.
std::optional<FittedPlace> searchAll(const DensityPatches& patches, float constant,
                                     const std::optional<FittedPlace>& camera, int threads) {
  const std::optional<FittedPlace> found = detail::searchStation(patches, constant, threads);
  return camera && !(found && explainsFarMore(*found, *camera, constant)) ? camera : found;
}

// \param cameras of which an image tells; empty = none
FoundSensor findStation(const DensityPatches& patches, float constant, const SensorOptions& options,
                        const std::vector<Views::Revealed>& cameras) {
  const std::optional<FittedPlace> suggested = trySuggestions(patches, constant, options);
  const std::optional<FittedPlace> camera = tryCameras(patches, constant, cameras);
  std::optional<FittedPlace> found;
  if (options.search) {
    found = searchAll(patches, constant, camera, options.threads);
  } else if (suggested) {
    found = detail::fitBeside(patches, *suggested);
  }
  if (suggested && !(found && betters(*found, *suggested, constant, patches))) {
    return describe(*suggested, constant, true);
  }
  if (!found || !options.search) return {};
  FoundSensor out = describe(*found, constant, false);
  if (camera && found->place.position == camera->place.position) {
    out.evidence = SensorEvidence::IMAGE;
  }
  return out;
}

// Whether a place is under the cloud's ground, about as far away as that is wide: of what a camera
// sees that looks along +z, the upper side is the other one.
bool isUnder(const detail::Extent& ground, const std::array<float, 3>& place) {
  const std::array<double, 3> p = inDouble(place.data());
  for (std::size_t a = 0; a < 2; ++a) {
    if (!(p[a] >= ground.low[a] && p[a] <= ground.high[a])) return false;
  }
  const double below = ground.low[2] - p[2];
  return below > 0.0 && below < 2.0 * ground.diagonal();
}

// Even densities tell of no sensor. What no upright line meets twice has one side that faces up.
void lookForUpperSide(PreparedCloud& cloud, const DensityPatches& patches,
                      const SensorOptions& options, SensorReport& out) {
  if (!options.search || patches.size() == 0) return;
  const detail::Extent ground = detail::extentOf(patches);
  for (const std::array<float, 3>& s : options.suggestions) {
    if (isUnder(ground, s)) return;
  }
  out.faces_up = detail::measureHeightField(cloud, patches).sure();
  if (out.faces_up) out.why += ", but it is one surface over the ground, whose upper side is seen";
}

// \param frame in another one than the cloud's, nothing is to be suggested
// \param has_axes whether the scene lies along the cloud's axes
// \param out has the deviations
void searchPlaces(const detail::SceneFrame& frame, bool has_axes, const DensityPatches& patches,
                  PreparedCloud& cloud, const SensorOptions& options,
                  const std::vector<Views::Revealed>& cameras, SensorReport& out) {
  FoundSensor sensor = findStation(frame.into(patches), out.deviation, options, cameras);
  frame.back(sensor);
  // Several stations around a body, most points from one of them, look like one at some place, and
  // somewhat like one at many.
  const bool searched = sensor.kind == SensorKind::STATION && !sensor.suggested;
  const bool is_weak = sensor.suggested && sensor.cost_ratio > detail::kSureFound;
  if (sensor.sure && (searched || is_weak)) {
    sensor.sure = !detail::findShadows(cloud.points(), sensor.position, options.threads).deny();
  }
  if (sensor.sure) {
    setOnly(sensor,
            sensor.suggested ? "the suggested place explains the densities"
                             : "one place explains the densities",
            out);
    return;
  }
  out.why = "no places explain the densities";
  if (!options.search || out.deviation < kFarBeyondChance * out.chance) return;
  if (frame.isOwn()) {
    detail::findSeveral(cloud, patches, has_axes, options.threads, out);
  } else {
    detail::findSeveralTurned(frame, cloud, patches, options.threads, out);
  }
}

// What was found in the cloud's own coordinates, or in the scene's frame if that explains more. A
// place that was suggested is exact, and one layer over the ground is one in upright clouds only.
SensorReport searchUpright(const DensityPatches& patches, PreparedCloud& cloud,
                           const SensorOptions& options, Views& views, const SensorReport& empty) {
  const detail::SceneFrame frame(patches);
  SensorReport own = empty;
  const std::vector<Views::Revealed> none;
  searchPlaces({}, frame.isOwn(), patches, cloud, options, options.search ? views.cameras() : none,
               own);
  const bool stands = own.sure() && (own.sensors[0].suggested ||
                                     own.sensors[0].evidence != SensorEvidence::DENSITY);
  if (stands || frame.isOwn() || !options.search) return own;
  SensorOptions without = options;
  without.suggestions.clear();
  SensorReport turned = empty;
  searchPlaces(frame, true, patches, cloud, without, none, turned);
  const bool knows_side = own.sure() || !own.directions.empty();
  const bool is_better =
      turned.sure() ? !own.sure() || turned.sensors[0].cost_ratio < own.sensors[0].cost_ratio
                    : !knows_side && !turned.directions.empty();
  return is_better ? turned : own;
}

// By densities and layers; in the unit of the cloud, sensor_of by its points.
SensorReport searchSensors(PreparedCloud& cloud, const SensorOptions& options, Views& views) {
  SensorReport out;
  out.sensor_of.assign(cloud.size(), -1);
  const DensityPatches patches =
      detail::densityPatches(cloud.points(), cloud.index(), options.threads);
  if (!patches.tell_laws) {
    out.why = "too few flat neighbourhoods to measure densities by";
    lookForUpperSide(cloud, patches, options, out);
    return out;
  }
  out.deviation = detail::deviation(patches.log_density);
  out.chance = detail::chanceDeviation(patches.k);
  if (out.deviation < kMoreThanChance * out.chance) {
    out.why = "the density is even";
    lookForUpperSide(cloud, patches, options, out);
    return out;
  }
  return searchUpright(patches, cloud, options, views, out);
}

// A place that shadows reveal, in the cloud's unit.
void setRevealed(const std::array<float, 3>& place, const detail::Shadows& shadows, const char* why,
                 detail::SeenShadows& seen, SensorReport& out) {
  seen.of_sensor = shadows;
  FoundSensor sensor;
  sensor.evidence = SensorEvidence::SHADOWS;
  sensor.position = place;
  sensor.cost_ratio = shadows.coveredOfSteps();
  sensor.sure = true;
  out.directions.clear();
  out.faces_up = false;
  setOnly(sensor, why, out);
}

// Thinned clouds have lost their densities, which leaves who hides whom. That there is one layer
// over the ground says less.
bool trySuggestedShadows(PreparedCloud& cloud, const detail::FlatPoints& flat,
                         const SensorOptions& options, detail::SeenShadows& seen,
                         SensorReport& out) {
  for (const std::array<float, 3>& suggestion : options.suggestions) {
    if (suggestion == seen.nothing_at) continue;
    const std::array<float, 3> s = cloud.inUnit(suggestion);
    const detail::Shadows shadows = detail::findShadows(flat, s, options.threads, true);
    if (!shadows.reveal()) continue;
    setRevealed(s, shadows, "surfaces end at the shadows that the suggested place casts", seen,
                out);
    out.sensors[0].suggested = true;
    return true;
  }
  return false;
}

// What looks at the middle of the cloud.
void setCamera(const detail::FlatPoints& flat, FoundSensor& sensor) {
  const std::array<float, 3> middle = flat.middle();
  std::array<double, 3> gaze{};
  for (std::size_t a = 0; a < 3; ++a) {
    gaze[a] = static_cast<double>(middle[a]) - static_cast<double>(sensor.position[a]);
  }
  sensor.kind = SensorKind::CAMERA;
  sensor.evidence = SensorEvidence::IMAGE;
  unitVector(gaze, sensor.axis.data());
}

void lookForShadows(PreparedCloud& cloud, const SensorOptions& options, Views& views,
                    detail::SeenShadows& seen, SensorReport& out) {
  if (out.sure() && out.sensors[0].kind != SensorKind::ABOVE) return;
  const detail::FlatPoints& flat = views.flat();
  if (trySuggestedShadows(cloud, flat, options, seen, out)) return;
  if (!options.search || out.sure() || out.faces_up || !out.directions.empty()) return;
  if (!views.cameras().empty()) {
    const auto& [apex, shadows] = views.cameras().front();
    setRevealed(apex, shadows, "the sides of an image meet where surfaces end at the shadows", seen,
                out);
    setCamera(flat, out.sensors[0]);
    return;
  }
  out.directions = detail::directionsInARoom(cloud.points(), flat, options.threads);
  if (!out.directions.empty()) out.why += ", but surfaces end at shadows as seen from within";
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
    SensorOptions scaled = options;
    for (std::array<float, 3>& s : scaled.suggestions) s = cloud.inUnit(s);
    Views views(cloud, options.threads);
    out = searchSensors(cloud, scaled, views);
    lookForShadows(cloud, options, views, shadows, out);
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
