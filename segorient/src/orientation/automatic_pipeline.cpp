// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
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
#include "orientation/sensors/place_choice.h"
#include "orientation/sensors/point_hints.h"
#include "orientation/sensors/sensor_hints.h"

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

// A column of unknown places, as some files have it, says no more than none.
std::shared_ptr<const OrientationHints> givenHints(const PipelineOptions& options) {
  const auto& given = options.orientation.hints;
  if (!given) return std::make_shared<OrientationHints>();
  const auto known = [](float v) { return std::isfinite(v); };
  if (given->viewpoints.empty() ||
      std::any_of(given->viewpoints.begin(), given->viewpoints.end(), known)) {
    return given;
  }
  auto out = std::make_shared<OrientationHints>(*given);
  out->viewpoints.clear();
  return out;
}

// \param hiding the place, where it is only to be compared with what is found without it
PointHints findHints(const PointView& points, const OrientationHints& given,
                     const PipelineOptions& options, PreparedCloud& cloud, PipelineReport& report,
                     std::optional<HidingPlace>& hiding) {
  PlaceChoice choice = choosePlaces(points, given, options.orientation.automatic.find_sensors,
                                    cloud, options.threads);
  PointHints known = resolveHints(choice.hints ? *choice.hints : given, cloud);
  known.place = choice.place;
  if (choice.refused) report.known_sensors.push_back(*choice.refused);
  if (choice.hiding) hiding = std::move(choice.hiding);
  report.sensors = std::move(choice.sensors);
  return known;
}

}  // namespace

void runAutomatic(const PointView& points, const PipelineOptions& options, StageClock& clock,
                  OrientedStages& work, PipelineReport& report) {
  const std::shared_ptr<const OrientationHints> given = givenHints(options);
  std::optional<HidingPlace> hiding;
  const auto runOnce = [&](const PointHints& known) {
    return runAutoStages(
        work.surface.cloud, options, known,
        [&clock](const char* stage, double fraction) { clock.begin(stage, fraction); });
  };
  const auto run = [&](const OrientationHints& hints) {
    AutoStages result =
        runOnce(findHints(points, hints, options, work.surface.cloud, report, hiding));
    if (!report.sensors.sure() || !seeBothSides(result.orientation.sensors)) return result;
    for (FoundSensor& s : report.sensors.sensors) s.sure = false;
    report.sensors.why += ", but see surfaces from both sides";
    return runOnce(resolveHints(withoutPlaces(*given), work.surface.cloud));
  };
  AutoStages result = run(*given);
  std::vector<KnownSensor> doubted = std::move(report.known_sensors);
  if (!hiding && doubted.empty() && saysPlaces(*given) && result.orientation.leavesAllToSurface()) {
    doubted = std::move(result.orientation.sensors);
    result = run(withoutPlaces(*given));
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
