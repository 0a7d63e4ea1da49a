// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "orientation/automatic/stages.h"
#include "orientation/pipeline_stages.h"
#include "orientation/sensors/given_places.h"
#include "orientation/sensors/hiding_place.h"
#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/place_choice.h"
#include "orientation/sensors/point_hints.h"
#include "orientation/sensors/room_shadows.h"
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

// Places that say nothing of any point are none.
std::shared_ptr<const OrientationHints> givenHints(const PointView& points,
                                                   const PreparedCloud& cloud,
                                                   const PipelineOptions& options) {
  const auto& given = options.orientation.hints;
  if (!given) return std::make_shared<OrientationHints>();
  const std::size_t rows = std::min(points.size, given->viewpoints.size() / 3);
  bool known = given->viewpoints.empty();
  for (std::size_t i = 0; i < rows && !known; ++i) {
    known = cloud.pointOf(i) >= 0 && saysPlace(&given->viewpoints[3 * i], points[i]);
  }
  if (known) return given;
  auto out = std::make_shared<OrientationHints>(*given);
  out->viewpoints.clear();
  return out;
}

// Whether each point has been told its own sensor, and not all of that is to be relied on.
bool isDoubtful(const OrientationHints& given, const std::vector<KnownSensor>& scans,
                const PreparedCloud& cloud) {
  return !scans.empty() && !given.viewpoints.empty() && !given.has_viewpoint &&
         !given.has_direction && !onlyPlace(given, cloud.rows()) && leavesDoubt(scans, cloud);
}

// The default method, again where what is known of sensors turns out to be wrong or not to be
// enough.
class AutomaticRun {
 public:
  AutomaticRun(const PointView& points, const PipelineOptions& options, StageClock& clock,
               PreparedCloud& cloud, PipelineReport& report)
      : points_(points), options_(options), clock_(clock), cloud_(cloud), report_(report) {}

  AutoStages run(const OrientationHints& given) {
    AutoStages result = findAndOrient(given);
    std::vector<KnownSensor> doubted = std::move(report_.known_sensors);
    if (!hiding_ && doubted.empty() && saysSensors(given) &&
        result.orientation.leavesAllToSurface()) {
      doubted = std::move(result.orientation.sensors);
      result = findAndOrient(withoutSensors(given));
    } else if (isDoubtful(given, result.orientation.sensors, cloud_)) {
      complete(given, doubted, result);
    }
    if (hiding_) {
      hiding_->report.used = hiding_->isPlausible(cloud_.points(), result.normals);
      doubted.push_back(hiding_->report);
    }
    report_.known_sensors = std::move(doubted);
    report_.known_sensors.insert(report_.known_sensors.end(), result.orientation.sensors.begin(),
                                 result.orientation.sensors.end());
    return result;
  }

 private:
  PlaceChoice choose(const OrientationHints& hints) {
    return choosePlaces(points_, hints, options_.orientation.automatic.find_sensors, cloud_,
                        options_.threads);
  }

  AutoStages orient(const PointHints& known) {
    return runAutoStages(cloud_, options_, known, [this](const char* stage, double fraction) {
      clock_.begin(stage, fraction);
    });
  }

  AutoStages findAndOrient(const OrientationHints& hints) {
    PlaceChoice choice = choose(hints);
    PointHints known = resolveHints(choice.hints ? *choice.hints : hints, cloud_);
    known.place = choice.place;
    known.either_side = std::move(choice.either_side);
    report_.seeds_left_out = hints.seeds.size() - known.seeds.size();
    if (choice.refused) report_.known_sensors.push_back(*choice.refused);
    if (choice.hiding) hiding_ = std::move(choice.hiding);
    report_.sensors = std::move(choice.sensors);
    AutoStages result = orient(known);
    if (choice.if_no_room && boundBodies(result.orientation.result.components)) {
      report_.sensors.why += ", and yet they bound bodies";
      known = resolveHints(withoutSensors(hints), cloud_);
      known.place = *choice.if_no_room;
      return orient(known);
    }
    if (!report_.sensors.sure() || !seeBothSides(result.orientation.sensors)) return result;
    for (FoundSensor& s : report_.sensors.sensors) s.sure = false;
    report_.sensors.why += ", but see surfaces from both sides";
    return orient(resolveHints(withoutSensors(hints), cloud_));
  }

  // What a search finds takes the place of what is not known or not to be relied on.
  void complete(const OrientationHints& given, std::vector<KnownSensor>& doubted,
                AutoStages& result) {
    PlaceChoice choice = choose(withoutSensors(given));
    if (!choice.sensors.sure()) return;
    std::vector<KnownSensor> scans = result.orientation.sensors;
    const std::optional<OrientationHints> completed =
        completePlaces(given, *choice.hints, choice.either_side, cloud_, result.orientation, scans);
    if (!completed) return;
    AutoStages second = orient(resolveHints(*completed, cloud_));
    if (seeBothSides(second.orientation.sensors)) return;
    std::copy_if(scans.begin(), scans.end(), std::back_inserter(doubted),
                 [](const KnownSensor& s) { return !s.used; });
    report_.sensors = std::move(choice.sensors);
    result = std::move(second);
  }

  const PointView& points_;
  const PipelineOptions& options_;
  StageClock& clock_;
  PreparedCloud& cloud_;
  PipelineReport& report_;
  std::optional<HidingPlace> hiding_;  // a place that is only to be compared with the result
};

}  // namespace

void runAutomatic(const PointView& points, const PipelineOptions& options, StageClock& clock,
                  OrientedStages& work, PipelineReport& report) {
  AutoStages result = AutomaticRun(points, options, clock, work.surface.cloud, report)
                          .run(*givenHints(points, work.surface.cloud, options));
  report.k = result.k;
  report.spacing = result.spacing;
  report.noise = result.noise;
  report.denoised = result.denoised;
  report.normals_chosen = sheetChoice(result);
  report.scales = std::move(result.scales);
  report.contradictions = std::move(result.orientation.contradictions);
  report.clusters = std::move(result.orientation.clusters);
  work.surface.normals = std::move(result.normals);
  work.surface.segmentation = std::move(result.segmentation);
  work.orientation.segments = std::move(result.segments);
  work.orientation.components = std::move(result.orientation.result.components);
  work.orientation.point_confidences = std::move(result.confidences);
  work.orientation.point_components = std::move(result.components);
}

}  // namespace segorient::detail
