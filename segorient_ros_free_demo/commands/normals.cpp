// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/result_columns.h"
#include "support/stage_options.h"
#include "support/stages.h"

namespace segorient::program {

int runNormals(const std::vector<std::string>& words) {
  CommandLine line("normals IN OUT [options]",
                   "Estimates a normal at every point of IN. Their signs are arbitrary: see\n"
                   "segorient orient. OUT (.pcd or .ply) has the points of IN in the same order,\n"
                   "with normals and curvature, and all other fields of IN.",
                   "segorient normals scan.ply normals.pcd --normals ldt");
  CommonOptions common;
  StageOptions stage_options;
  int rounds = 0;
  line.arguments({"IN", "OUT"});
  stage_options.add(line);
  line.options()(
      "recompute", boost::program_options::value(&rounds)->default_value(0),
      "rounds of recomputation at sharp edges: from one side's surface, or by the paper's "
      "rule where --delta is given");
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  require(rounds >= 0 && rounds <= 100, "--recompute must be 0 to 100");
  PipelineOptions options;
  stage_options.apply(line, common, options);
  requireEnding(line.argument("OUT"), {".pcd", ".ply"});

  OutputFile file(line.argument("OUT"));
  const CloudTable table = readUsableCloud(line.argument("IN"));
  const LocalPoints points(table);
  Stages stages(points.view(), options, !common.quiet);
  stages.findNormals();
  if (rounds > 0) {
    stages.findSegments();
    stages.recomputeNormals(rounds, stage_options.delta());
  }
  const std::vector<float> normals = stages.normals();
  OutputCloud out(table);
  addNormalColumns(normals, out);
  out.addRest(table);
  writeCloud(out, file);
  file.commit();
  if (common.quiet) return 0;
  std::size_t without = 0;
  for (std::size_t i = 0; i < table.size; ++i) without += std::isfinite(normals[4 * i]) ? 0 : 1;
  std::printf(
      "points          %zu\nwithout normal  %zu\nneighbours      %d, %s\nseconds         %s\n"
      "written         %s\n",
      table.size, without, stages.k(), estimatorName(options.normals.estimator),
      timesText(stages.times()).c_str(), file.path().c_str());
  return 0;
}

}  // namespace segorient::program
