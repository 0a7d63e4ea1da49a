// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/density_search.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/in_double.h"
#include "orientation/sensors/far_station.h"
#include "orientation/sensors/found_sensor.h"
#include "orientation/sensors/from_above.h"
#include "orientation/sensors/height_field.h"
#include "orientation/sensors/joint_sensors.h"
#include "orientation/sensors/scene_frame.h"
#include "orientation/sensors/shadows.h"
#include "orientation/sensors/station_search.h"
#include "orientation/sensors/vertex_lattice.h"

namespace segorient::detail {
namespace {

// Deviations of log density that are hardly more than chance have little to explain; where points
// do not fall at random, as on lines of a scanner, one place may still do it.
constexpr float kMoreThanChance = 1.3F;
// What a law may leave of the constant's deviation at a place that is looked at because it was
// suggested: true ones left .04 to .57, wrong ones .81 and more.
constexpr float kSureSuggested = 0.6F;
// Several sensors can adapt to much, so that there must be enough to adapt to: at twice the
// deviation of chance three quarters of the variance are something else.
constexpr float kFarBeyondChance = 2.F;

FoundSensor describe(const FittedPlace& fitted, float constant, bool suggested) {
  FoundSensor out;
  out.kind = fitted.place.law == SamplingLaw::PINHOLE ? SensorKind::CAMERA : SensorKind::STATION;
  out.position = toFloat(fitted.place.position);
  if (fitted.place.law != SamplingLaw::SOLID_ANGLE) out.axis = toFloat(fitted.place.axis);
  out.suggested = suggested;
  out.cost_ratio = fitted.cost / constant;
  out.sure = out.cost_ratio <= (suggested ? kSureSuggested : kSureFound);
  return out;
}

bool isEven(const DensityPatches& patches, float constant) {
  return constant < kMoreThanChance * chanceDeviation(patches.k);
}

// Of some places the one that fits best, if one leaves no more than `most`.
class BestFit {
 public:
  BestFit(const DensityPatches& patches, float most) : patches_(patches), most_(most) {}
  void add(const std::array<double, 3>& position) {
    const FittedPlace fitted = fitAt(patches_, position);
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
  const Extent extent = extentOf(patches);
  BestFit best(patches, kSureSuggested * constant);
  for (const std::array<float, 3>& s : options.suggestions) {
    const std::array<double, 3> position = inDouble(s.data());
    if (extent.holds(position, kFarthest * extent.diagonal())) best.add(position);
  }
  return best.get();
}

bool explainsFarMore(const FittedPlace& a, const FittedPlace& b, float constant) {
  return a.cost <= kMuchBetter * b.cost && a.cost <= b.cost - kGain * constant;
}

// From afar many places explain much. A suggested one stands unless the best of all, which has to
// be sure itself, explains far more, or more from the other side: of 58 true ones the best saw the
// same sides, of 17 that were one to five extents off it saw the others, or left .6 of what they
// did at most.
bool betters(const FittedPlace& found, const FittedPlace& suggested, float constant,
             const DensityPatches& patches) {
  if (found.cost > kSureFound * constant || found.cost >= suggested.cost) return false;
  return explainsFarMore(found, suggested, constant) ||
         2 * countTurned(patches, found, suggested) > patches.size();
}

// Cameras of which densities are sure.
std::optional<FittedPlace> tryCameras(const DensityPatches& patches, float constant,
                                      const std::vector<RevealedPlace>& cameras) {
  BestFit best(patches, kSureFound * constant);
  for (const RevealedPlace& camera : cameras) best.add(inDouble(camera.place.data()));
  return best.get();
}

// Across a plane a place leaves the same. Of what lies level the upper side was seen, unless the
// lower place explains more.
FittedPlace orUpperTwin(const DensityPatches& patches, const FittedPlace& found) {
  const std::array<double, 3> twin = patches.imageOf(found.place.position);
  if (!(twin[2] > found.place.position[2])) return found;
  const FittedPlace upper = fitBeside(patches, fitAt(patches, twin));
  return upper.cost <= kSameCost * found.cost ? upper : found;
}

struct FoundPlace {
  FoundSensor sensor;
  bool by_image = false;          // it is where the sides of an image meet
  bool from_either_side = false;  // a place explains the densities, and so does the one across
};

// \param cameras that the sides of an image and shadows tell of: where they explain densities about
//        as well as the best of all places, they are that
FoundPlace findStation(const DensityPatches& patches, float constant, const SensorOptions& options,
                       const std::vector<RevealedPlace>& cameras) {
  const std::optional<FittedPlace> suggested = trySuggestions(patches, constant, options);
  const std::optional<FittedPlace> camera = tryCameras(patches, constant, cameras);
  FoundPlace out;
  std::optional<FittedPlace> found;
  if (options.search) {
    found = searchStation(patches, constant, options.threads);
    if (found) {
      const FittedPlace best = orUpperTwin(patches, *found);
      found = sideOfFarPlace(patches, best, isEven(patches, constant), options.suggestions);
      out.from_either_side = !found && best.cost <= kSureFound * constant;
    }
    out.by_image = camera && !(found && explainsFarMore(*found, *camera, constant));
    if (out.by_image) found = camera;
  } else if (suggested) {
    found = fitBeside(patches, *suggested);
  }
  if (suggested && !(found && betters(*found, *suggested, constant, patches))) {
    return {describe(*suggested, constant, true)};
  }
  if (!found || !options.search) return out;
  out.sensor = describe(*found, constant, false);
  out.from_either_side = false;
  return out;
}

// Whether a place is under the cloud's ground, about as far away as that is wide: of what a camera
// sees that looks along +z, the upper side is the other one.
bool isUnderGround(const Extent& ground, const std::array<float, 3>& place) {
  const double below = ground.low[2] - static_cast<double>(place[2]);
  return below > 0.0 && below < 2.0 * ground.diagonal() &&
         looksUpAt(place, toFloat(ground.middle()));
}

// What all steps of the search look at.
struct Scene {
  const DensityPatches& patches;
  PreparedCloud& cloud;
  const SensorOptions& options;
  CameraViews& views;
  FromAbove& above;
};

// Where densities tell of no sensor, or not of its side: what no upright line meets twice has one
// side that faces up, and woods stand on the upper side of the ground.
void lookForUpperSide(const Scene& scene, SensorReport& out) {
  if (!scene.options.search || scene.patches.size() == 0) return;
  const Extent ground = extentOf(scene.patches);
  const bool is_under =
      std::any_of(scene.options.suggestions.begin(), scene.options.suggestions.end(),
                  [&](const std::array<float, 3>& s) { return isUnderGround(ground, s); });
  // No camera below sees woods: the ground is before them.
  const bool is_field = scene.above.field().sure();
  out.faces_up = is_field && !is_under;
  if (out.faces_up) {
    out.why += ", but it is one surface over the ground, whose upper side is seen";
  } else if (!is_field) {
    scene.above.lookOverWoods(out);
  }
}

// \param frame in another one than the cloud's, nothing is to be suggested
// \param options the scene's, or other suggestions
// \param has_axes whether the scene lies along the cloud's axes
// \param out has the deviations
// \return whether it is a place that is exact, as it was suggested or the sides of an image meet
// there
bool searchPlaces(const SceneFrame& frame, bool has_axes, const Scene& scene,
                  const SensorOptions& options, const std::vector<RevealedPlace>& cameras,
                  SensorReport& out) {
  auto [sensor, by_image, from_either_side] =
      findStation(frame.into(scene.patches), out.deviation, options, cameras);
  if (from_either_side) {
    out.why = "a far place explains the densities, but so does the one across";
    if (frame.isOwn()) lookForUpperSide(scene, out);
    return false;
  }
  frame.back(sensor);
  // Several stations around a body, most points from one of them, look like one at some place, and
  // somewhat like one at many.
  const bool searched = !sensor.suggested && !by_image;
  const bool is_weak = sensor.suggested && sensor.cost_ratio > kSureFound;
  if (sensor.sure && (searched || is_weak)) {
    sensor.sure = !findShadows(scene.views.flat(), sensor.position, options.threads).contradict();
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
    findSeveral(scene.cloud, scene.patches, has_axes, scene.above, options.threads, out);
  } else {
    findSeveralTurned(frame, scene.cloud, scene.patches, options.threads, out);
  }
  return false;
}

// What was found in the cloud's own coordinates, or in the scene's frame if that explains more. One
// layer over the ground is one in upright clouds only.
SensorReport searchUpright(const Scene& scene, const SensorReport& empty) {
  const SensorOptions& options = scene.options;
  const SceneFrame frame(scene.patches);
  SensorReport own = empty;
  const std::vector<RevealedPlace> none;
  const bool exact = searchPlaces({}, frame.isOwn(), scene, options,
                                  options.search ? scene.views.cameras() : none, own);
  if (exact || isOverGround(own) || frame.isOwn() || !options.search) return own;
  SensorOptions without = options;
  without.suggestions.clear();
  SensorReport turned = empty;
  searchPlaces(frame, true, scene, without, none, turned);
  const bool knows_side = own.sure() || !own.directions.empty();
  const bool is_better =
      turned.sure() ? !own.sure() || turned.sensors[0].cost_ratio < own.sensors[0].cost_ratio
                    : !knows_side && !turned.directions.empty();
  return is_better ? turned : own;
}

bool isALattice(const Scene& scene) {
  return formALattice(scene.cloud.points(), scene.cloud.index(), scene.options.threads);
}

// Vertices of a body that was turned on a lathe, or that is a function of the direction, have the
// density of a scan from within it, and those of a rod that of one from its axis. They are a
// lattice, unlike what several stations saw.
bool areInABody(const SensorReport& found, const Scene& scene) {
  const int threads = scene.options.threads;
  const SensorKind kind = found.sensors[0].kind;
  if (found.sensors[0].evidence != SensorEvidence::DENSITY || kind == SensorKind::ABOVE) {
    return false;
  }
  const bool on_its_way = kind == SensorKind::MOVING;
  const bool are_several = found.sensors.size() > 1;
  if (are_several && !on_its_way && !isALattice(scene)) return false;
  const bool has_walls = scene.patches.haveWalls();
  std::vector<Shadows> seen;
  for (const FoundSensor& sensor : found.sensors) {
    seen.push_back(findShadows(scene.views.flat(), sensor.position, threads));
    // In walls each place has to look like it, but of a way the median does.
    if (has_walls && !on_its_way && !seen.back().asOfABody(true, are_several)) return false;
  }
  return areAtOneBody(seen, has_walls, on_its_way);
}

// Stations near the middle of a hollow are much like one there, from where it looks like a body.
void lookForSeveralInstead(const SensorReport& one, const Scene& scene, SensorReport& several) {
  if (one.sensors.size() > 1 || one.deviation < kFarBeyondChance * one.chance) return;
  if (isALattice(scene)) return;
  findSeveral(scene.cloud, scene.patches, SceneFrame(scene.patches).isOwn(), scene.above,
              scene.options.threads, several);
  const bool are_stations =
      several.sensors.size() > 1 && several.sensors[0].kind == SensorKind::STATION;
  if (!are_stations || several.sensors[0].cost_ratio > kMuchBetter * one.sensors[0].cost_ratio) {
    several = {};
  }
}

}  // namespace

SensorReport searchByDensity(PreparedCloud& cloud, const SensorOptions& options,
                             CameraViews& views) {
  SensorReport out;
  out.sensor_of.assign(cloud.size(), -1);
  const DensityPatches patches = densityPatches(cloud.points(), cloud.index(), options.threads);
  FromAbove above(cloud, patches, views.flatOnce(), options.threads);
  const Scene scene{patches, cloud, options, views, above};
  if (!patches.tell_laws) {
    out.why = "too few flat neighbourhoods to measure densities by";
    lookForUpperSide(scene, out);
    return out;
  }
  out.deviation = deviation(patches.log_density);
  out.chance = chanceDeviation(patches.k);
  const SensorReport empty = out;
  out = searchUpright(scene, empty);
  if (out.sure() && areInABody(out, scene)) {
    SensorReport several = empty;
    if (options.search) lookForSeveralInstead(out, scene, several);
    if (several.sure()) return several;
    for (FoundSensor& sensor : out.sensors) sensor.sure = false;
    std::fill(out.sensor_of.begin(), out.sensor_of.end(), -1);
    out.either_side.clear();
    out.why = "from the places that explain the densities it looks like a body";
  }
  if (out.sure()) return out;
  if (isEven(patches, out.deviation)) {
    if (out.sensors.empty()) out.why = "the density is even";
    lookForUpperSide(scene, out);
  } else if (options.search && out.directions.empty()) {
    above.lookOverWoods(out);
  }
  return out;
}

}  // namespace segorient::detail
