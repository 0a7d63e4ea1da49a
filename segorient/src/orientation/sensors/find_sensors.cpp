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
#include "orientation/sensors/height_field.h"
#include "orientation/sensors/image_rays.h"
#include "orientation/sensors/joint_sensors.h"
#include "orientation/sensors/room_shadows.h"
#include "orientation/sensors/scene_frame.h"
#include "orientation/sensors/sensor_search.h"
#include "orientation/sensors/shadows.h"
#include "orientation/sensors/station_search.h"

namespace segorient {

using detail::CameraViews;
using detail::DensityPatches;
using detail::FittedPlace;
using detail::RevealedPlace;
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

// Of some places the one that fits best, if one leaves no more than `most`.
class BestFit {
 public:
  BestFit(const DensityPatches& patches, float most) : patches_(patches), most_(most) {}
  void add(const std::array<double, 3>& position) {
    const FittedPlace fitted = detail::fitAt(patches_, position);
    if (fitted.cost > most_) return;
    if (!best_ || fitted.cost < best_->cost) best_ = fitted;
  }
  const std::optional<FittedPlace>& get() const { return best_; }

 private:
  const DensityPatches& patches_;
  float most_;
  std::optional<FittedPlace> best_;
};

std::optional<FittedPlace> trySuggestions(const DensityPatches& patches, float constant,
                                          const SensorOptions& options) {
  const detail::Extent extent = detail::extentOf(patches);
  BestFit best(patches, kSureSuggested * constant);
  for (const std::array<float, 3>& s : options.suggestions) {
    const std::array<double, 3> position = inDouble(s.data());
    if (extent.holds(position, kFarthest * extent.diagonal())) best.add(position);
  }
  return best.get();
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

// Cameras of which densities are sure.
std::optional<FittedPlace> tryCameras(const DensityPatches& patches, float constant,
                                      const std::vector<RevealedPlace>& cameras) {
  BestFit best(patches, detail::kSureFound * constant);
  for (const RevealedPlace& camera : cameras) best.add(inDouble(camera.place.data()));
  return best.get();
}

struct FoundPlace {
  FoundSensor sensor;
  bool by_image = false;  // it is where the sides of an image meet
};

// \param cameras that the sides of an image and shadows tell of: where they explain densities about
//        as well as the best of all places, they are that
FoundPlace findStation(const DensityPatches& patches, float constant, const SensorOptions& options,
                       const std::vector<RevealedPlace>& cameras) {
  const std::optional<FittedPlace> suggested = trySuggestions(patches, constant, options);
  const std::optional<FittedPlace> camera = tryCameras(patches, constant, cameras);
  std::optional<FittedPlace> found;
  bool by_image = false;
  if (options.search) {
    found = detail::searchStation(patches, constant, options.threads);
    by_image = camera && !(found && explainsFarMore(*found, *camera, constant));
    if (by_image) found = camera;
  } else if (suggested) {
    found = detail::fitBeside(patches, *suggested);
  }
  if (suggested && !(found && betters(*found, *suggested, constant, patches))) {
    return {describe(*suggested, constant, true), false};
  }
  if (!found || !options.search) return {};
  return {describe(*found, constant, false), by_image};
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
// \return whether it is a place that is exact, as it was suggested or the sides of an image meet
// there
bool searchPlaces(const detail::SceneFrame& frame, bool has_axes, const DensityPatches& patches,
                  PreparedCloud& cloud, const SensorOptions& options,
                  const std::vector<RevealedPlace>& cameras, SensorReport& out) {
  auto [sensor, by_image] = findStation(frame.into(patches), out.deviation, options, cameras);
  frame.back(sensor);
  // Several stations around a body, most points from one of them, look like one at some place, and
  // somewhat like one at many.
  const bool searched = sensor.kind == SensorKind::STATION && !sensor.suggested && !by_image;
  const bool is_weak = sensor.suggested && sensor.cost_ratio > detail::kSureFound;
  if (sensor.sure && (searched || is_weak)) {
    sensor.sure = !detail::findShadows(cloud.points(), sensor.position, options.threads).deny();
  }
  if (sensor.sure) {
    setOnly(sensor,
            sensor.suggested ? "the suggested place explains the densities"
            : by_image       ? "the place where the sides of an image meet explains the densities"
                             : "one place explains the densities",
            out);
    return sensor.suggested || by_image;
  }
  out.why = "no places explain the densities";
  if (!options.search || out.deviation < kFarBeyondChance * out.chance) return false;
  if (frame.isOwn()) {
    detail::findSeveral(cloud, patches, has_axes, options.threads, out);
  } else {
    detail::findSeveralTurned(frame, cloud, patches, options.threads, out);
  }
  return false;
}

// What was found in the cloud's own coordinates, or in the scene's frame if that explains more. One
// layer over the ground is one in upright clouds only.
SensorReport searchUpright(const DensityPatches& patches, PreparedCloud& cloud,
                           const SensorOptions& options, CameraViews& views,
                           const SensorReport& empty) {
  const detail::SceneFrame frame(patches);
  SensorReport own = empty;
  const std::vector<RevealedPlace> none;
  const bool exact = searchPlaces({}, frame.isOwn(), patches, cloud, options,
                                  options.search ? views.cameras() : none, own);
  const bool by_layers = own.sure() && own.sensors[0].evidence == SensorEvidence::LAYERS;
  if (exact || by_layers || frame.isOwn() || !options.search) return own;
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
SensorReport searchSensors(PreparedCloud& cloud, const SensorOptions& options, CameraViews& views) {
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

// A place in the cloud's unit that shadows reveal, or allow where a whole image tells of it.
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
                                                 const detail::SeenShadows& seen) {
  for (const std::array<float, 3>& suggestion : options.suggestions) {
    if (suggestion == seen.nothing_at) continue;
    const std::array<float, 3> s = cloud.inUnit(suggestion);
    const detail::Shadows shadows = detail::findShadows(views.flat(), s, options.threads, true);
    if (shadows.reveal()) return RevealedPlace{s, shadows};
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
    if (!out.directions.empty()) out.why += ", but surfaces end at shadows as seen from within";
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

// In the unit of the cloud. All four sides of an image tell of its camera if shadows allow it.
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
    out = searchSensors(cloud, scaled, views);
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
