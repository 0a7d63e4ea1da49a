// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/first_stages.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "common/peak_memory.h"
#include "features/automatic_normals.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/stages.h"
#include "orientation/cloud_scale.h"
#include "orientation/former_settings.h"
#include "orientation/orient_segments.h"
#include "orientation/sensors/point_hints.h"
#include "orientation/sensors/sensor_hints.h"
#include "orientation/stage_clock.h"
#include "orientation/surface_stages.h"
#include "segmentation/segment_graph.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// What the stages find out about the points of a cloud.
struct Working {
  detail::SurfaceStages surface;
  OrientationResult orientation;
};

// The paper's stages (2.1 to 2.3.1), and its methods of orientation (3).
void runPaper(const PipelineOptions& options, detail::StageClock& clock, Working& work,
              PipelineReport& report) {
  detail::SurfaceStages& surface = work.surface;
  const CloudScale scale = measureScale(surface.cloud.points(), surface.cloud.index());
  report.spacing = scale.spacing;
  report.noise = scale.noise;
  surface.findNeighbors(options.k > 0 ? options.k : neighborsForNoise(scale.noise));
  report.k = surface.k;
  clock.begin("normals", 0.4);
  surface.findNormals(options);
  report.normals_chosen = surface.normals_chosen;
  surface.recomputeNormals(options, clock);
  clock.begin("segmentation", 0.75);
  SegmentationOptions cuts{options.segmentation, 0, options.threads};
  cuts.unite_smooth = false;
  // A point of a thin part that is given to the other side's segment is turned over with it.
  cuts.settle_edges = false;
  surface.findSegments(cuts);
  clock.begin("orientation", 0.8);
  const OrientationOptions how{options.orientation, options.threads};
  const Neighborhoods& neighborhoods = surface.cloud.neighborhoods();
  const SegmentGraph graph = buildSegmentGraph(surface.segmentation, neighborhoods);
  work.orientation = orientSegments(surface.cloud.points(), surface.normalView(), neighborhoods,
                                    surface.segmentation, graph, how);
}

// Turns the distinct points' normals and segments as they were oriented. The normals' own signs now
// say it all, so a point's sign in its segment is what is left: -1 where it disagrees with it.
void applyOrientation(Working& work) {
  const OrientationResult& orientation = work.orientation;
  std::vector<float>& normals = work.surface.normals;
  Segmentation& segmentation = work.surface.segmentation;
  for (std::size_t i = 0; i < work.surface.cloud.size(); ++i) {
    const auto sign = static_cast<float>(orientation.point_signs[i]);
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] *= sign == 0.F ? kNaN : sign;
    if (sign == 0.F) normals[4 * i + 3] = kNaN;
    const std::int32_t label = segmentation.labels[i];
    if (label < 0) continue;
    const int segment_sign = orientation.segments[static_cast<std::size_t>(label)].sign;
    segmentation.signs[i] =
        static_cast<std::int8_t>(segmentation.signs[i] * orientation.point_signs[i] * segment_sign);
  }
  for (std::size_t s = 0; s < segmentation.segments.size(); ++s) {
    for (float& c : segmentation.segments[s].reference_normal) {
      c *= static_cast<float>(orientation.segments[s].sign);
    }
  }
}

// What the default method chose, and why.
std::string sheetChoice(const detail::AutoStages& stages) {
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

// What the caller knows, and where nothing is known of sensors, what can be found. One place for
// all points may be a guess of whoever gives it: densities that tell it for sure know better.
PointHints findHints(const PointView& points, const PipelineOptions& options, PreparedCloud& cloud,
                     PipelineReport& report) {
  const OrientationHints& given = givenHints(options);
  const std::optional<std::array<float, 3>> place = detail::onlyPlace(given);
  OrientationHints found = place ? detail::withoutPlaces(given) : given;
  if (!options.orientation.automatic.find_sensors || !detail::lacksSensors(found)) {
    return resolveHints(given, cloud);
  }
  if (place) found.suggested.push_back(*place);
  SensorReport sensors = detail::addFoundSensors(points, cloud, options.threads, found);
  if (place && !detail::contradictsPlace(points, sensors, *place)) {
    return resolveHints(given, cloud);
  }
  if (place) {
    KnownSensor refused;
    for (std::size_t a = 0; a < 3; ++a) refused.position[a] = (*place)[a] / cloud.unit();
    refused.points = static_cast<std::uint32_t>(cloud.size());
    refused.used = false;
    report.known_sensors.push_back(refused);
  }
  report.sensors = std::move(sensors);
  return resolveHints(found, cloud);
}

// Whether places were given, and none of them is believed.
bool refusesAll(const std::vector<KnownSensor>& sensors) {
  return !sensors.empty() &&
         std::none_of(sensors.begin(), sensors.end(), [](const KnownSensor& s) { return s.used; });
}

// The default method brings its own stages; its normals come out oriented.
void runAutomatic(const PointView& points, const PipelineOptions& options,
                  detail::StageClock& clock, Working& work, PipelineReport& report) {
  const PointHints hints = findHints(points, options, work.surface.cloud, report);
  detail::AutoStages result = detail::runAutoStages(
      work.surface.cloud, options, hints,
      [&clock](const char* stage, double fraction) { clock.begin(stage, fraction); });
  std::vector<KnownSensor> refused = std::move(report.known_sensors);
  if (refused.empty() && refusesAll(result.orientation.sensors)) {
    // As if nothing had been said.
    PipelineOptions without = options;
    without.orientation.hints =
        std::make_shared<OrientationHints>(detail::withoutPlaces(givenHints(options)));
    refused = std::move(result.orientation.sensors);
    const PointHints rest = findHints(points, without, work.surface.cloud, report);
    result = detail::runAutoStages(
        work.surface.cloud, options, rest,
        [&clock](const char* stage, double fraction) { clock.begin(stage, fraction); });
  }
  report.k = result.k;
  report.spacing = result.spacing;
  report.noise = result.noise;
  report.denoised = result.denoised;
  report.normals_chosen = sheetChoice(result);
  report.contradictions = std::move(result.orientation.contradictions);
  report.clusters = std::move(result.orientation.clusters);
  report.known_sensors = std::move(refused);
  report.known_sensors.insert(report.known_sensors.end(), result.orientation.sensors.begin(),
                              result.orientation.sensors.end());
  work.surface.normals = std::move(result.normals);
  work.surface.segmentation = std::move(result.segmentation);
  work.orientation.segments = std::move(result.segments);
  work.orientation.components = std::move(result.orientation.result.components);
  work.orientation.point_confidences = std::move(result.confidences);
  work.orientation.point_components = std::move(result.components);
}

// From points to input rows, lengths back to the input's unit.
void scatter(const Working& work, OrientedCloud& out) {
  const PreparedCloud& cloud = work.surface.cloud;
  out.normals = cloud.scatter(work.surface.normals, 4, kNaN);
  out.confidences = cloud.scatter(work.orientation.point_confidences, 1, 0.F);
  out.components = cloud.scatter(work.orientation.point_components, 1, std::int32_t{-1});
  out.segmentation = segmentation::scatter(cloud, work.surface.segmentation);
  out.segments = work.orientation.segments;
  out.report.spacing *= cloud.unit();
  for (Contradiction& c : out.report.contradictions) {
    for (float& v : c.where) v *= cloud.unit();
  }
  for (KnownSensor& s : out.report.known_sensors) {
    for (float& v : s.position) v *= cloud.unit();
  }
}

void fillReport(const Working& work, const OrientedCloud& cloud, PipelineReport& report) {
  report.points = work.surface.cloud.rows();
  report.non_finite = work.surface.cloud.withoutPoint();
  report.duplicates = work.surface.cloud.duplicates();
  for (std::size_t row = 0; row < cloud.confidences.size(); ++row) {
    if (!std::isfinite(cloud.normals[4 * row])) ++report.without_normal;
  }
  for (std::size_t s = 0; s < cloud.segments.size(); ++s) {
    switch (cloud.segmentation.segments[s].kind) {
      case SegmentKind::REGULAR:
        ++report.regular_segments;
        break;
      case SegmentKind::CONNECTED:
        ++report.connected_segments;
        break;
      case SegmentKind::ISOLATED:
        ++report.isolated_segments;
        break;
    }
    if (cloud.segments[s].hard) ++report.hard_segments;
  }
  report.components = work.orientation.components;
  report.peak_memory = peakMemory();
}

// Where only some rows were asked for: what the report says about rows is about those.
void countRows(const PreparedCloud& cloud, const std::vector<pcl::index_t>& indices,
               PipelineReport& report) {
  report.points = indices.size();
  report.non_finite =
      static_cast<std::size_t>(std::count_if(indices.begin(), indices.end(), [&](pcl::index_t row) {
        return row < 0 || static_cast<std::size_t>(row) >= cloud.rows() ||
               cloud.pointOf(static_cast<std::size_t>(row)) < 0;
      }));
  report.duplicates = report.points - report.non_finite - cloud.size();
}

// Segments by the paper's stages alone.
OrientedCloud firstStages(const PointView& points, const PipelineOptions& options,
                          const PipelineProgress& progress) {
  FirstStages stages(points, options, progress);
  stages.findNormals();
  stages.findSegments();
  OrientedCloud out;
  out.normals = stages.normals();
  out.segmentation = stages.segmentation();
  out.report.points = points.size;
  out.report.non_finite = stages.nonFinite();
  out.report.duplicates = stages.duplicates();
  out.report.k = stages.k();
  out.report.normals_chosen = stages.normalsChosen();
  out.report.stages = stages.times();
  return out;
}

}  // namespace

OrientedCloud orientCloud(const PointView& points, const std::vector<pcl::index_t>* indices,
                          const PipelineOptions& given, const PipelineProgress& progress) {
  const PipelineOptions options = detail::withFormerSettings(given);
  OrientedCloud out;
  out.report.method = options.orientation.method;
  out.report.estimator = options.normals.estimator;
  detail::StageClock clock(progress);
  Working work;
  // Fractions: shares of the time on clouds of a million points.
  clock.begin("search", 0.0);
  work.surface.cloud = PreparedCloud(points, indices, options.threads);
  if (options.orientation.method == OrientationMethod::AUTO) {
    runAutomatic(points, options, clock, work, out.report);
  } else {
    runPaper(options, clock, work, out.report);
    applyOrientation(work);
  }
  clock.begin("output", 0.95);
  scatter(work, out);
  if (indices != nullptr) out = selectRows(out, *indices);
  fillReport(work, out, out.report);
  if (indices != nullptr) countRows(work.surface.cloud, *indices, out.report);
  clock.end();
  out.report.stages = clock.times();
  for (const StageTime& stage : out.report.stages) out.report.seconds += stage.seconds;
  if (progress) progress("output", 1.0);
  return out;
}

OrientedCloud segmentCloud(const PointView& points, const PipelineOptions& options,
                           const PipelineProgress& progress) {
  const bool automatic = options.orientation.method == OrientationMethod::AUTO;
  const bool own_normals =
      options.normals.estimator != NormalEstimator::AUTO || options.recomputations > 0;
  OrientedCloud out = automatic && own_normals ? firstStages(points, options, progress)
                                               : orientCloud(points, nullptr, options, progress);
  for (std::size_t row = 0; row < out.segmentation.signs.size(); ++row) {
    std::int8_t& sign = out.segmentation.signs[row];
    for (std::size_t a = 0; a < 3 && sign < 0; ++a) out.normals[4 * row + a] *= -1.F;
    sign = std::abs(sign);
  }
  return out;
}

std::size_t expectedMemory(std::size_t points, const PipelineOptions& options) {
  const bool automatic = options.orientation.method == OrientationMethod::AUTO;
  constexpr int kMostByNoise = 30;
  const auto k = static_cast<std::size_t>(options.k > 0 ? options.k
                                          : automatic   ? kSheetNeighbors
                                                        : kMostByNoise);
  // The table of neighbours, with distances where the paper's methods want them, and all else, as
  // measured on clouds of one to ten million points.
  const std::size_t entry = automatic ? sizeof(pcl::index_t) : sizeof(pcl::index_t) + sizeof(float);
  constexpr std::size_t kElse = 150;
  // Automatic normals of noisy clouds have neighbours of their own for a while.
  const bool wider =
      !automatic && options.k <= 0 && options.normals.estimator == NormalEstimator::AUTO;
  const std::size_t wide =
      wider ? sizeof(pcl::index_t) * static_cast<std::size_t>(kMostAutomaticNeighbors + 1) : 0;
  return points * (entry * (k + 1) + wide + kElse);
}

OrientedCloud selectRows(const OrientedCloud& cloud, const std::vector<pcl::index_t>& rows) {
  OrientedCloud out;
  out.report = cloud.report;
  out.segments = cloud.segments;
  out.segmentation.segments = cloud.segmentation.segments;
  out.normals.assign(4 * rows.size(), kNaN);
  out.confidences.assign(rows.size(), 0.F);
  out.components.assign(rows.size(), -1);
  out.segmentation.labels.assign(rows.size(), -1);
  out.segmentation.signs.assign(rows.size(), 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < 0 || static_cast<std::size_t>(rows[i]) >= cloud.confidences.size()) continue;
    const auto row = static_cast<std::size_t>(rows[i]);
    std::copy_n(&cloud.normals[4 * row], 4, &out.normals[4 * i]);
    out.confidences[i] = cloud.confidences[row];
    out.components[i] = cloud.components[row];
    out.segmentation.labels[i] = cloud.segmentation.labels[row];
    out.segmentation.signs[i] = cloud.segmentation.signs[row];
  }
  segmentation::collectMembers(out.segmentation);
  return out;
}

}  // namespace segorient
