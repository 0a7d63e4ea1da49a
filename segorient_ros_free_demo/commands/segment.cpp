// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/pipeline.h>

#include <array>
#include <boost/program_options.hpp>
#include <cstdio>
#include <optional>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "orientation/report_fields.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/json.h"
#include "support/progress_bar.h"
#include "support/result_columns.h"
#include "support/stage_memory.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

void printSummary(const OrientedCloud& cloud, std::size_t without_normal, const std::string& path) {
  std::array<std::size_t, 3> count{0, 0, 0};
  std::array<std::size_t, 3> points{0, 0, 0};
  for (const Segment& s : cloud.segmentation.segments) {
    ++count[static_cast<std::size_t>(s.kind)];
    points[static_cast<std::size_t>(s.kind)] += s.size;
  }
  std::printf("points     %zu, %zu not finite, %zu duplicates; %zu without normal\n",
              cloud.segmentation.labels.size(), cloud.report.non_finite, cloud.report.duplicates,
              without_normal);
  for (const SegmentKind kind :
       {SegmentKind::REGULAR, SegmentKind::CONNECTED, SegmentKind::ISOLATED}) {
    std::printf("%-10s %zu segments of %zu points\n", detail::nameOf(kind),
                count[static_cast<std::size_t>(kind)], points[static_cast<std::size_t>(kind)]);
  }
  std::printf("normals    %s\nseconds    %s\nwritten    %s\n", cloud.report.normals_chosen.c_str(),
              timesText(cloud.report.stages).c_str(), path.c_str());
}

std::string reportText(const OrientedCloud& cloud, const StageMemory& memory,
                       std::size_t without_normal, const std::array<double, 3>& origin) {
  const Segmentation& segmentation = cloud.segmentation;
  JsonWriter json;
  json.field("points", segmentation.labels.size());
  json.field("non_finite", cloud.report.non_finite);
  json.field("duplicates", cloud.report.duplicates);
  json.field("without_normal", without_normal);
  json.field("k", cloud.report.k);
  json.field("normals_chosen", cloud.report.normals_chosen);
  json.beginObject("seconds");
  double total = 0.0;
  for (const StageTime& s : cloud.report.stages) {
    json.field(s.stage, s.seconds);
    total += s.seconds;
  }
  json.field("total", total);
  json.endObject();
  json.field("peak_memory_bytes", memory.most());
  addTo(json, memory);
  json.beginArray("segments");
  for (std::size_t i = 0; i < segmentation.segments.size(); ++i) {
    const Segment& s = segmentation.segments[i];
    json.beginItem();
    json.field("label", i);
    json.field("kind", detail::nameOf(s.kind));
    json.field("points", s.size);
    json.field("area", s.area);
    json.field("rms", s.rms);
    json.beginArray("reference_normal");
    for (const float v : s.reference_normal) json.item(v);
    json.endArray();
    json.beginArray("centroid");
    for (std::size_t a = 0; a < 3; ++a) {
      json.item(origin[a] + static_cast<double>(s.centroid[a]));
    }
    json.endArray();
    json.endObject();
  }
  json.endArray();
  return json.finish();
}

}  // namespace

int runSegment(const std::vector<std::string>& words) {
  CommandLine line(
      "segment IN OUT [options]",
      "Cuts IN into segments of similar normals: those that orient and triangulate have\n"
      "with the same options, --method among them. With --normals or --recompute, and\n"
      "method auto: faces by those normals, with points at edges given to the face that\n"
      "passes nearest. OUT (.pcd, .ply, .las) has the points of IN in the same order,\n"
      "with normals that agree within each segment, curvature,\n"
      "colours, labels (largest segment first; 4294967295: in none) and segment_kind\n"
      "(0 regular, 1 connected, 2 isolated), and all other fields of IN but its rgb.",
      "segorient segment scan.ply segments.pcd --beta 25");
  CommonOptions common;
  StageOptions stage_options;
  HintOptions hints;
  bool faces = false;
  bool split = false;
  std::string report_path;
  line.arguments({"IN", "OUT"});
  stage_options.add(line, LastStage::SEGMENTS, "32, with --normals or --recompute 12");
  hints.add(line);
  line.options()("faces", po::bool_switch(&faces),
                 "unite segments whose common border is smooth: a cylinder is one face then")(
      "report", po::value(&report_path), "a table of the segments, as JSON");
  // What --faces is not; up to version 1.0 it had to be asked for.
  line.unlisted()("split", po::bool_switch(&split));
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  require(!(faces && split), "--faces and --split contradict each other");
  PipelineOptions options;
  stage_options.apply(line, common, options);
  options.segmentation.unite_smooth = faces;
  hints.check(line, common, options);
  stage_options.warnOfUnused(line, common, options);
  requireEnding(line.argument("OUT"), {".pcd", ".ply", ".las"});
  for (const char* name : {"IN", "OUT"}) requireOwnReport(report_path, line.argument(name), name);

  OutputFile file(line.argument("OUT"));
  std::optional<OutputFile> report;
  if (!report_path.empty()) report.emplace(report_path);
  StageMemory memory(!common.quiet || report);
  memory.begin("reading");
  const CloudTable table = hints.read({line.argument("IN")}, common.quiet);
  const LocalPoints points(table);
  hints.apply(table, line.argument("IN"), points, options);
  ProgressBar bar(!common.quiet, table.size);
  const OrientedCloud cloud = segmentCloud(points.view(), options, memory.watch(bar.callback()));
  memory.begin("output");
  Results results;
  results.normals = &cloud.normals;
  results.segmentation = &cloud.segmentation;
  results.kinds = true;
  memory.begin("writing");
  writeResults(table, results, file);
  memory.end();
  const std::size_t without_normal = countWithoutNormal(cloud.normals);
  if (report) report->write(reportText(cloud, memory, without_normal, points.origin()));
  file.commit();
  if (report) report->commit();
  if (!common.quiet) printSummary(cloud, without_normal, file.path());
  return 0;
}

}  // namespace segorient::program
