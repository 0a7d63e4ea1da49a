// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/first_stages.h>

#include <array>
#include <boost/program_options.hpp>
#include <cstdio>
#include <optional>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/json.h"
#include "support/progress_bar.h"
#include "support/result_columns.h"
#include "support/stage_memory.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

void printSummary(const FirstStages& stages, const Segmentation& segmentation,
                  std::size_t without_normal, const std::string& path) {
  std::array<std::size_t, 3> count{0, 0, 0};
  std::array<std::size_t, 3> points{0, 0, 0};
  for (const Segment& s : segmentation.segments) {
    ++count[static_cast<std::size_t>(s.kind)];
    points[static_cast<std::size_t>(s.kind)] += s.size;
  }
  std::printf("points     %zu, %zu not finite, %zu duplicates; %zu without normal\n",
              segmentation.labels.size(), stages.nonFinite(), stages.duplicates(), without_normal);
  for (const SegmentKind kind :
       {SegmentKind::Regular, SegmentKind::Connected, SegmentKind::Isolated}) {
    std::printf("%-10s %zu segments of %zu points\n", kindName(kind),
                count[static_cast<std::size_t>(kind)], points[static_cast<std::size_t>(kind)]);
  }
  std::printf("normals    %s\nseconds    %s\nwritten    %s\n", stages.normalsChosen().c_str(),
              timesText(stages.times()).c_str(), path.c_str());
}

std::string reportText(const FirstStages& stages, const StageMemory& memory,
                       const Segmentation& segmentation, std::size_t without_normal,
                       const std::array<double, 3>& origin) {
  JsonWriter json;
  json.field("points", segmentation.labels.size());
  json.field("non_finite", stages.nonFinite());
  json.field("duplicates", stages.duplicates());
  json.field("without_normal", without_normal);
  json.field("k", stages.k());
  json.field("normals_chosen", stages.normalsChosen());
  json.beginObject("seconds");
  double total = 0.0;
  for (const StageTime& s : stages.times()) {
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
    json.field("kind", kindName(s.kind));
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
      "Cuts IN into faces: segments of similar normals, those united whose common border\n"
      "is smooth unless --split is given. OUT (.pcd, .ply, .las) has the points of\n"
      "IN in the same order, with normals that agree within each segment, curvature,\n"
      "colours, labels (largest segment first; 4294967295: in none) and segment_kind\n"
      "(0 regular, 1 connected, 2 isolated), and all other fields of IN but its rgb.",
      "segorient segment scan.ply segments.pcd --beta 25");
  CommonOptions common;
  StageOptions stage_options;
  bool split = false;
  std::string report_path;
  line.arguments({"IN", "OUT"});
  stage_options.add(line, false);
  line.options()("split", po::bool_switch(&split),
                 "leave round faces cut up by --beta, as triangulate and orient use them")(
      "report", po::value(&report_path), "a table of the segments, as JSON");
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  PipelineOptions options;
  stage_options.apply(line, common, options);
  stage_options.warnOfUnused(line, common, options);
  requireEnding(line.argument("OUT"), {".pcd", ".ply", ".las"});

  if (report_path == line.argument("OUT")) throw UsageError("--report and OUT are the same file");

  OutputFile file(line.argument("OUT"));
  std::optional<OutputFile> report;
  if (!report_path.empty()) report.emplace(report_path);
  StageMemory memory(!common.quiet || report);
  memory.begin("reading");
  const CloudTable table = readUsableCloud(line.argument("IN"));
  const LocalPoints points(table);
  ProgressBar bar(!common.quiet, table.size);
  FirstStages stages(points.view(), options, memory.watch(bar.callback()));
  stages.findNormals();
  stages.findSegments(split);
  memory.begin("output");
  const Segmentation segmentation = stages.segmentation();
  const std::vector<float> normals = stages.normalsBySegment();
  Results results;
  results.normals = &normals;
  results.segmentation = &segmentation;
  results.kinds = true;
  memory.begin("writing");
  writeResults(table, results, file);
  memory.end();
  const std::size_t without_normal = countWithoutNormal(normals);
  if (report)
    report->write(reportText(stages, memory, segmentation, without_normal, points.origin()));
  file.commit();
  if (report) report->commit();
  if (!common.quiet) printSummary(stages, segmentation, without_normal, file.path());
  return 0;
}

}  // namespace segorient::program
