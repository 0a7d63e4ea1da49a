// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/pipeline.h>

#include <array>
#include <cstdio>
#include <optional>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/component_report.h"
#include "support/hint_options.h"
#include "support/json.h"
#include "support/memory.h"
#include "support/progress_bar.h"
#include "support/result_columns.h"
#include "support/sensor_report.h"
#include "support/stage_memory.h"
#include "support/stage_options.h"
#include "support/tile_flags.h"
#include "tiles/run_tiles.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

constexpr std::size_t kComponentsShown = 5;

void printSummary(const PipelineReport& report, const StageMemory& memory,
                  const std::array<double, 3>& origin, const std::string& out, bool verbose) {
  std::printf("points          %zu", report.points);
  if (report.non_finite > 0) std::printf(", %zu not finite", report.non_finite);
  if (report.duplicates > 0) std::printf(", %zu duplicates", report.duplicates);
  std::printf("\nwithout normal  %zu\n", report.without_normal);
  std::printf("segments        %zu regular, %zu connected, %zu isolated\n", report.regular_segments,
              report.connected_segments, report.isolated_segments);
  std::printf("neighbours      %d; spacing %.4g, noise %.2f spacings\n", report.k,
              static_cast<double>(report.spacing), static_cast<double>(report.noise));
  std::printf("normals         %s\n", report.normals_chosen.c_str());
  for (const FoundSensor& s : report.sensors.sensors) {
    std::printf("sensor found    %s\n", describeSensor(s, origin).c_str());
  }
  std::printf("components      %zu, oriented by method %s\n", report.components.size(),
              toString(report.method));
  for (std::size_t i = 0; i < report.components.size(); ++i) {
    if (i == kComponentsShown && !verbose) {
      std::printf("  and %zu more\n", report.components.size() - i);
      break;
    }
    const ComponentOrientationResult& c = report.components[i];
    std::printf("  %9zu points, outside by %s, confidence %.2f\n", c.points, toString(c.by),
                static_cast<double>(c.confidence));
  }
  if (!report.contradictions.empty()) {
    const auto& where = report.contradictions[0].where;
    std::printf(
        "contradictions  %zu, near (%g, %g, %g) first: the surface has one side only, or folds\n",
        report.contradictions.size(), origin[0] + static_cast<double>(where[0]),
        origin[1] + static_cast<double>(where[1]), origin[2] + static_cast<double>(where[2]));
  }
  for (const KnownSensor& s : report.known_sensors) {
    if (s.used) continue;
    std::printf(
        "not followed    the sensor at (%g, %g, %g) contradicts the surface of its %zu points\n",
        origin[0] + static_cast<double>(s.position[0]),
        origin[1] + static_cast<double>(s.position[1]),
        origin[2] + static_cast<double>(s.position[2]), s.points);
  }
  std::printf("seconds         %.2f: %s\n", report.seconds, timesText(report.stages).c_str());
  std::printf("peak memory     %.0f MB\n", static_cast<double>(memory.most()) / 1048576.0);
  std::printf("written         %s\n", out.c_str());
}

void addKnownSensors(const PipelineReport& report, const std::array<double, 3>& origin,
                     JsonWriter& json) {
  json.beginArray("known_sensors");
  for (const KnownSensor& s : report.known_sensors) {
    json.beginItem();
    json.field("x", origin[0] + static_cast<double>(s.position[0]));
    json.field("y", origin[1] + static_cast<double>(s.position[1]));
    json.field("z", origin[2] + static_cast<double>(s.position[2]));
    json.field("points", s.points);
    json.field("seen", s.seen);
    json.field("used", s.used);
    json.field("moving", s.moving);
    json.field("hidden", s.hidden);
    json.field("contrary", s.contrary);
    json.field("density", s.density);
    json.endObject();
  }
  json.endArray();
}

void addScales(const PipelineReport& report, JsonWriter& json) {
  json.beginArray("scales");
  for (const ScaleEnergy& s : report.scales) {
    json.beginItem();
    json.field("radius_in_spacings", s.radius);
    json.field("outside", s.outside);
    json.field("facing", s.facing);
    json.field("backs", s.backs);
    json.field("energy", s.total);
    json.field("taken", s.taken);
    json.endObject();
  }
  json.endArray();
}

void addSegments(const OrientedCloud& cloud, JsonWriter& json) {
  json.beginArray("segments");
  for (std::size_t i = 0; i < cloud.segments.size(); ++i) {
    const Segment& s = cloud.segmentation.segments[i];
    const SegmentOrientationResult& r = cloud.segments[i];
    json.beginItem();
    json.field("label", i);
    json.field("kind", kindName(s.kind));
    json.field("points", s.size);
    json.field("component", r.component);
    json.field("sign", static_cast<int>(r.sign));
    json.field("oriented_by", toString(r.by));
    json.field("confidence", r.confidence);
    json.field("extremal_agreement", r.extremal_agreement);
    json.field("hard", r.hard);
    json.endObject();
  }
  json.endArray();
  json.beginArray("hard_segments");
  for (std::size_t i = 0; i < cloud.segments.size(); ++i) {
    if (cloud.segments[i].hard) json.item(i);
  }
  json.endArray();
}

std::string reportText(const OrientedCloud& cloud, const StageMemory& memory,
                       const std::array<double, 3>& origin) {
  const PipelineReport& report = cloud.report;
  JsonWriter json;
  json.field("points", report.points);
  json.field("non_finite", report.non_finite);
  json.field("duplicates", report.duplicates);
  json.field("without_normal", report.without_normal);
  json.field("k", report.k);
  json.field("normals",
             report.method == OrientationMethod::AUTO ? "own" : estimatorName(report.estimator));
  json.field("normals_chosen", report.normals_chosen);
  json.field("method", toString(report.method));
  json.field("spacing", report.spacing);
  json.field("noise_in_spacings", report.noise);
  json.field("denoised", report.denoised);
  json.beginObject("segments_by_kind");
  json.field("regular", report.regular_segments);
  json.field("connected", report.connected_segments);
  json.field("isolated", report.isolated_segments);
  json.field("hard", report.hard_segments);
  json.endObject();
  json.beginObject("seconds");
  for (const StageTime& s : report.stages) json.field(s.stage, s.seconds);
  json.field("total", report.seconds);
  json.endObject();
  json.field("peak_memory_bytes", memory.most());
  addTo(json, memory);
  addTo(json, report.components);
  json.beginArray("clusters");
  for (const ClusterOrientationResult& c : report.clusters) {
    json.beginItem();
    json.field("points", c.points);
    json.field("component", c.component);
    json.field("confidence", c.confidence);
    json.endObject();
  }
  json.endArray();
  json.beginArray("contradictions");
  for (const Contradiction& c : report.contradictions) {
    json.beginItem();
    json.field("x", origin[0] + static_cast<double>(c.where[0]));
    json.field("y", origin[1] + static_cast<double>(c.where[1]));
    json.field("z", origin[2] + static_cast<double>(c.where[2]));
    json.field("weight", c.weight);
    json.endObject();
  }
  json.endArray();
  addScales(report, json);
  addKnownSensors(report, origin, json);
  addTo(json, report.sensors, origin);
  addSegments(cloud, json);
  return json.finish();
}

}  // namespace

int runOrient(const std::vector<std::string>& words) {
  CommandLine line(
      "orient IN... OUT [options]",
      "Gives every point of IN a normal; the normals point outward where there is an\n"
      "outside, and agree with each other where there is none. OUT (.pcd, .ply or .las)\n"
      "has the points of IN in the same order, with normals, curvature, segment labels\n"
      "and colours, and all other fields of IN. Defaults need no tuning.\n"
      "Several IN, each with its own sensor, become one OUT, one after another, with\n"
      "fields scan (0, 1, ...) and vp_x vp_y vp_z (where the sensor was).",
      "segorient orient scan.ply oriented.pcd --report report.json");
  CommonOptions common;
  StageOptions stages;
  HintOptions hints;
  std::string report_path;
  TileFlags tiles;
  line.argumentsMany("IN", "OUT");
  stages.add(line, LastStage::ORIENTATION);
  hints.add(line);
  tiles.add(line);
  line.options()("report", po::value(&report_path), "what was done, as JSON");
  common.add(line, "a summary of all components");
  if (!line.parse(words)) return 0;
  common.check();
  PipelineOptions options;
  stages.apply(line, common, options);
  hints.check(line, common, options);
  stages.warnOfUnused(line, common, options);
  if (report_path == line.argument("OUT")) throw UsageError("--report and OUT are the same file");
  if (tiles.wanted() || tiles.needed(line, common, options)) {
    runAllSteps(tiles.request(line, common, options, hints), tiles.folder(), report_path,
                common.quiet);
    return 0;
  }
  requireEnding(line.argument("OUT"), {".pcd", ".ply", ".las"});

  OutputFile out(line.argument("OUT"));
  std::optional<OutputFile> report;
  if (!report_path.empty()) report.emplace(report_path);
  StageMemory memory(!common.quiet || report);
  memory.begin("reading");
  const std::string& first = line.inputs()[0];
  const CloudTable table = hints.read(line.inputs(), common.quiet);
  requireMemory(first, expectedMemory(table.size, options), availableMemory());
  OrientedCloud cloud;
  std::array<double, 3> origin{0, 0, 0};
  {
    const LocalPoints points(table);
    origin = points.origin();
    hints.apply(table, first, points, options);
    ProgressBar bar(!common.quiet, table.size);
    cloud = orientCloud(points.view(), nullptr, options, memory.watch(bar.callback()));
  }
  memory.begin("writing");
  Results results;
  results.normals = &cloud.normals;
  results.segmentation = &cloud.segmentation;
  results.keep_colors = true;  // worth more than ours; the label tells the segments
  writeResults(table, results, out);
  memory.end();
  if (report) report->write(reportText(cloud, memory, origin));
  if (report) report->finish();
  out.commit();
  if (report) report->commit();
  if (!common.quiet) printSummary(cloud.report, memory, origin, out.path(), common.verbose);
  return 0;
}

}  // namespace segorient::program
