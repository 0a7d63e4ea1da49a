// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/first_stages.h>

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

void printSummary(const FirstStages& stages, const std::vector<float>& normals,
                  const PipelineOptions& options, const std::string& path) {
  std::printf(
      "points          %zu\nwithout normal  %zu\nneighbours      %d, %s\nnormals         %s\n"
      "seconds         %s\nwritten         %s\n",
      normals.size() / 4, countWithoutNormal(normals), stages.k(),
      estimatorName(options.normals.estimator), stages.normalsChosen().c_str(),
      timesText(stages.times()).c_str(), path.c_str());
}

}  // namespace

int runNormals(const std::vector<std::string>& words) {
  CommandLine line(
      "normals IN OUT [options]",
      "Estimates a normal at every point of IN. Their signs are arbitrary: see\n"
      "segorient orient. OUT (.pcd, .ply, .las) has the points of IN in the same order,\n"
      "with normals and curvature, and all other fields of IN.",
      "segorient normals scan.ply normals.pcd --normals ldt");
  CommonOptions common;
  StageOptions stage_options;
  line.arguments({"IN", "OUT"});
  stage_options.add(line, LastStage::NORMALS);
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  PipelineOptions options;
  stage_options.apply(line, common, options);
  stage_options.warnOfUnused(line, common, options);
  requireEnding(line.argument("OUT"), {".pcd", ".ply", ".las"});

  OutputFile file(line.argument("OUT"));
  const CloudTable table = readUsableCloud(line.argument("IN"));
  const LocalPoints points(table);
  ProgressBar bar(!common.quiet, table.size);
  FirstStages stages(points.view(), options, bar.callback());
  stages.findNormals();
  const std::vector<float> normals = stages.normals();
  Results results;
  results.normals = &normals;
  writeResults(table, results, file);
  file.commit();
  if (!common.quiet) printSummary(stages, normals, options, file.path());
  return 0;
}

}  // namespace segorient::program
