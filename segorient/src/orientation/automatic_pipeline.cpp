// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "orientation/automatic/stages.h"
#include "orientation/pipeline_stages.h"
#include "orientation/sensors/hiding_place.h"
#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/point_hints.h"
#include "orientation/sensors/sensor_hints.h"
#include "orientation/sensors/shadows.h"

namespace segorient::detail {
namespace {

// What the default method chose, and why.
std::string sheetChoice(const AutoStages& stages) {
  std::ostringstream text;
  text << std::setprecision(2) << "noise " << stages.noise << " of the spacing, "
       << (stages.denoised ? "too much to see the surface by few points, so positions were smoothed"
                           : "so positions stay as they are")
       << "; planes of one sheet each, of as few of " << stages.k
       << " neighbours as the noise allows";
  if (stages.level > 0.F) {
    text << "; points contradict each other as layers do that do not quite fit: signs from an even "
            "subset, "
         << stages.level << " spacings apart";
  }
  return text.str();
}

const OrientationHints& givenHints(const PipelineOptions& options) {
  static const OrientationHints kNone;
  return options.orientation.hints ? *options.orientation.hints : kNone;
}

PipelineOptions withHints(const PipelineOptions& options, OrientationHints hints) {
  PipelineOptions out = options;
  out.orientation.hints = std::make_shared<OrientationHints>(std::move(hints));
  return out;
}

// As if no place had been given.
PipelineOptions asIfUnseen(const PipelineOptions& options) {
  return withHints(options, withoutPlaces(givenHints(options)));
}

// The same, and nobody had thought of that place.
PipelineOptions asIfNotThere(const PipelineOptions& options, const std::array<float, 3>& place) {
  OrientationHints hints = withoutPlaces(givenHints(options));
  auto& suggested = hints.suggested;
  suggested.erase(std::remove(suggested.begin(), suggested.end(), place), suggested.end());
  return withHints(options, std::move(hints));
}

// A column of unknown places, as some files have it, says no more than none.
PipelineOptions withoutUnknownPlaces(const PipelineOptions& options) {
  const std::vector<float>& places = givenHints(options).viewpoints;
  if (places.empty() ||
      std::any_of(places.begin(), places.end(), [](float v) { return std::isfinite(v); })) {
    return options;
  }
  OrientationHints hints = givenHints(options);
  hints.viewpoints.clear();
  return withHints(options, std::move(hints));
}

// One place for all points that nothing was turned to.
KnownSensor refusedPlace(const std::array<float, 3>& place, const PreparedCloud& cloud) {
  KnownSensor out;
  out.position = cloud.inUnit(place);
  out.points = cloud.size();
  out.used = false;
  return out;
}

// What the caller knows, and where nothing is known of sensors, what can be found. One place for
// all points may be a guess of whoever gives it: unless shadows confirm it, sensors that densities
// tell for sure are followed, if they are not in that place, too.
// \param hiding the place, where it is only to be compared with what is found without it
PointHints findHints(const PointView& points, const PipelineOptions& options, PreparedCloud& cloud,
                     PipelineReport& report, std::optional<HidingPlace>& hiding) {
  const OrientationHints& given = givenHints(options);
  const std::optional<std::array<float, 3>> place = onlyPlace(given, points.size);
  OrientationHints found = place ? withoutPlaces(given) : given;
  if (!options.orientation.automatic.find_sensors || !lacksSensors(found)) {
    return resolveHints(given, cloud);
  }
  const bool is_place = place && isFinite(place->data());
  Shadows shadows;
  SeenShadows seen;
  if (is_place && !isImage(given, points.size)) {
    shadows = findShadows(cloud.points(), cloud.inUnit(*place), options.threads);
    // What does not confirm a place reveals none.
    seen.nothing_at = place;
  }
  if (shadows.confirm()) {
    PointHints known = resolveHints(given, cloud);
    known.shadows = shadows;
    return known;
  }
  if (is_place) found.suggested.push_back(*place);
  SensorReport sensors = addFoundSensors(points, cloud, options.threads, found, seen);
  if (is_place && !contradictsPlace(cloud, sensors, *place)) {
    PointHints known = resolveHints(given, cloud);
    known.shadows = shadows;
    known.place_found = sensors.sure() && !sensors.sensors[0].suggested;
    const bool is_fact = known.place_found || !given.viewpoints.empty();
    if (is_fact || given.surface == SurfaceKind::OPEN || !shadows.deny()) return known;
    hiding = lookFrom(cloud.points(), cloud.inUnit(*place), options.threads);
    // What was found in that very place is no more than compared, either.
    if (sensors.sure()) {
      return findHints(points, asIfNotThere(options, *place), cloud, report, hiding);
    }
  } else if (place) {
    report.known_sensors.push_back(refusedPlace(*place, cloud));
  }
  report.sensors = std::move(sensors);
  if (report.sensors.sensors.empty()) report.sensors.sensor_of = {};
  PointHints known = resolveHints(found, cloud);
  known.shadows = seen.of_sensor;
  return known;
}

// Whether places are given: those that are found would be found again.
bool saysPlaces(const OrientationHints& hints) {
  return hints.has_viewpoint || !hints.viewpoints.empty();
}

// Whether places were given, and they decided nothing: none is believed, or the surface knows
// better everywhere.
bool leavesAllToSurface(const AutoOrientation& found) {
  return !found.sensors.empty() &&
         (found.place_idle || std::none_of(found.sensors.begin(), found.sensors.end(),
                                           [](const KnownSensor& s) { return s.used; }));
}

}  // namespace

void runAutomatic(const PointView& points, const PipelineOptions& given, StageClock& clock,
                  OrientedStages& work, PipelineReport& report) {
  const PipelineOptions options = withoutUnknownPlaces(given);
  std::optional<HidingPlace> hiding;
  const auto runOnce = [&](const PointHints& known) {
    return runAutoStages(
        work.surface.cloud, options, known,
        [&clock](const char* stage, double fraction) { clock.begin(stage, fraction); });
  };
  const auto run = [&](const PointHints& known) {
    AutoStages result = runOnce(known);
    if (!report.sensors.sure() || !seeBothSides(result.orientation.sensors)) return result;
    for (FoundSensor& s : report.sensors.sensors) s.sure = false;
    report.sensors.why += ", but see surfaces from both sides";
    return runOnce(resolveHints(withoutPlaces(givenHints(options)), work.surface.cloud));
  };
  AutoStages result = run(findHints(points, options, work.surface.cloud, report, hiding));
  std::vector<KnownSensor> doubted = std::move(report.known_sensors);
  if (!hiding && doubted.empty() && saysPlaces(givenHints(options)) &&
      leavesAllToSurface(result.orientation)) {
    doubted = std::move(result.orientation.sensors);
    result = run(findHints(points, asIfUnseen(options), work.surface.cloud, report, hiding));
  }
  if (hiding) {
    hiding->report.used = hiding->isPlausible(work.surface.cloud.points(), result.normals);
    doubted.push_back(hiding->report);
  }
  report.k = result.k;
  report.spacing = result.spacing;
  report.noise = result.noise;
  report.denoised = result.denoised;
  report.normals_chosen = sheetChoice(result);
  report.scales = std::move(result.scales);
  report.contradictions = std::move(result.orientation.contradictions);
  report.clusters = std::move(result.orientation.clusters);
  report.known_sensors = std::move(doubted);
  report.known_sensors.insert(report.known_sensors.end(), result.orientation.sensors.begin(),
                              result.orientation.sensors.end());
  work.surface.normals = std::move(result.normals);
  work.surface.segmentation = std::move(result.segmentation);
  work.orientation.segments = std::move(result.segments);
  work.orientation.components = std::move(result.orientation.result.components);
  work.orientation.point_confidences = std::move(result.confidences);
  work.orientation.point_components = std::move(result.components);
}

}  // namespace segorient::detail
