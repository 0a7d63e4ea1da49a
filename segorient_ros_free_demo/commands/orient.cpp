// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/pipeline.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/json.h"
#include "support/memory.h"
#include "support/progress_bar.h"
#include "support/report_lists.h"
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
  printNotFollowed(report.known_sensors, origin, 16);
  printSeedsLeftOut(report.seeds_left_out, 16);
  std::printf("seconds         %.2f: %s\n", report.seconds, timesText(report.stages).c_str());
  std::printf("peak memory     %.0f MB\n", static_cast<double>(memory.most()) / 1048576.0);
  std::printf("written         %s\n", out.c_str());
}

void addSegments(const OrientedCloud& cloud, JsonWriter& json) {
  std::vector<detail::ReportedSegment> segments;
  for (std::size_t i = 0; i < cloud.segments.size(); ++i) {
    segments.push_back({i, cloud.segmentation.segments[i], cloud.segments[i]});
  }
  addList(json, "segments", segments);
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
  addList(json, "components", report.components);
  addList(json, "clusters", report.clusters);
  addList(json, "contradictions", report.contradictions, origin);
  addList(json, "scales", report.scales);
  addList(json, "scale_components", detail::componentsOf(report.scales));
  addList(json, "known_sensors", report.known_sensors, origin);
  json.field("seeds_left_out", report.seeds_left_out);
  addList(json, "sensors", report.sensors.sensors, origin);
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
      "and colours, and all other fields of IN. Colours that IN has are kept instead. In\n"
      "PLY, normals are nx ny nz, colours red green blue. Defaults need no tuning.\n"
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
  requireOwnReport(report_path, line.argument("OUT"), "OUT");
  for (const std::string& in : line.inputs()) requireOwnReport(report_path, in, "IN");
  if (tiles.wanted() || tiles.needed(line, common, options)) {
    runAllSteps(tiles.request(line, common, options, hints), tiles.folder(), report_path,
                common.quiet);
    return 0;
  }
  for (const std::string& in : line.inputs()) {
    if (std::filesystem::is_directory(in)) {
      throw FileError(in, "is a directory; its clouds are read with --memory, as in --memory 4G");
    }
  }
  requireEnding(line.argument("OUT"), {".pcd", ".ply", ".las"});
  if (!common.quiet) nameUnused(line, {"work"}, "without --memory");

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
