// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/first_stages.h>

#include <array>
#include <cstdio>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/progress_bar.h"
#include "support/result_columns.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace {

void printSummary(const FirstStages& stages, const Segmentation& segmentation,
                  const std::string& path) {
  std::array<std::size_t, 3> count{0, 0, 0};
  std::array<std::size_t, 3> points{0, 0, 0};
  for (const Segment& s : segmentation.segments) {
    ++count[static_cast<std::size_t>(s.kind)];
    points[static_cast<std::size_t>(s.kind)] += s.size;
  }
  std::printf("points     %zu, %zu not finite, %zu duplicates\n", segmentation.labels.size(),
              stages.nonFinite(), stages.duplicates());
  for (const SegmentKind kind :
       {SegmentKind::Regular, SegmentKind::Connected, SegmentKind::Isolated}) {
    std::printf("%-10s %zu segments of %zu points\n", kindName(kind),
                count[static_cast<std::size_t>(kind)], points[static_cast<std::size_t>(kind)]);
  }
  std::printf("seconds    %s\nwritten    %s\n", timesText(stages.times()).c_str(), path.c_str());
}

}  // namespace

int runSegment(const std::vector<std::string>& words) {
  CommandLine line(
      "segment IN OUT [options]",
      "Cuts IN into segments of similar normals. OUT (.pcd or .ply) has the points of\n"
      "IN in the same order, with normals that agree within each segment, curvature,\n"
      "colours, labels (largest segment first; 4294967295: in none) and segment_kind\n"
      "(0 regular, 1 connected, 2 isolated), and all other fields of IN but its rgb.",
      "segorient segment scan.ply segments.pcd --beta 25");
  CommonOptions common;
  StageOptions stage_options;
  line.arguments({"IN", "OUT"});
  stage_options.add(line);
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  PipelineOptions options;
  stage_options.apply(line, common, options);
  requireEnding(line.argument("OUT"), {".pcd", ".ply"});

  OutputFile file(line.argument("OUT"));
  const CloudTable table = readUsableCloud(line.argument("IN"));
  const LocalPoints points(table);
  ProgressBar bar(!common.quiet, table.size);
  FirstStages stages(points.view(), options, bar.callback());
  stages.findNormals();
  stages.findSegments();
  if (options.recomputations > 0) {
    stages.recomputeNormals();
    stages.findSegments();
  }
  const Segmentation segmentation = stages.segmentation();
  const std::vector<float> normals = stages.normalsBySegment();
  Results results;
  results.normals = &normals;
  results.segmentation = &segmentation;
  results.kinds = true;
  writeResults(table, results, file);
  file.commit();
  if (!common.quiet) printSummary(stages, segmentation, file.path());
  return 0;
}

}  // namespace segorient::program
