// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/pipeline.h>
#include <segorient/surface/segment_mesh.h>

#include <cstdio>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/progress_bar.h"
#include "support/result_columns.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

std::vector<Triangle> allTriangles(const std::vector<SegmentMesh>& meshes) {
  std::vector<Triangle> out;
  for (const SegmentMesh& mesh : meshes) {
    for (const auto& t : mesh.triangles) {
      out.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                     static_cast<std::uint32_t>(t[2])});
    }
  }
  return out;
}

}  // namespace

int runTriangulate(const std::vector<std::string>& words) {
  CommandLine line(
      "triangulate IN OUT [options]",
      "Orients IN and triangulates each of its segments. OUT (.ply or .vtk) is one mesh:\n"
      "the points of IN in the same order, coloured by segment, and all triangles, their\n"
      "fronts outward. Segments do not meet: there are gaps along sharp edges.",
      "segorient triangulate scan.ply segments.vtk");
  CommonOptions common;
  StageOptions stages;
  HintOptions hints;
  TriangulationOptions triangulation;
  bool all = false;
  line.arguments({"IN", "OUT"});
  stages.add(line, LastStage::ORIENTATION);
  hints.add(line);
  line.options()("kappa1",
                 po::value(&triangulation.kappa1)->default_value(triangulation.kappa1, "0.1"),
                 "share of the fullest bin of edge lengths that counts as a maximum")(
      "kappa2", po::value(&triangulation.kappa2)->default_value(triangulation.kappa2, "0.7"),
      "share of the critical length that edges on the boundary may have")(
      "all", po::bool_switch(&all), "connected and isolated segments, too");
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  require(triangulation.kappa1 >= 0.F && triangulation.kappa1 <= 1.F, "--kappa1 must be 0 to 1");
  require(triangulation.kappa2 > 0.F, "--kappa2 must be above 0");
  PipelineOptions options;
  stages.apply(line, common, options);
  hints.check(line, common, options);
  stages.warnOfUnused(line, common, options);
  requireEnding(line.argument("OUT"), {".ply", ".vtk"});

  OutputFile file(line.argument("OUT"));
  const CloudTable table = hints.read({line.argument("IN")}, common.quiet);
  const LocalPoints points(table);
  hints.apply(table, line.argument("IN"), points, options);
  OrientedCloud cloud;
  std::vector<Triangle> triangles;
  {
    ProgressBar bar(!common.quiet, table.size);
    // Triangulation takes about a fifth of the time.
    cloud = orientCloud(points.view(), nullptr, options, [&](const char* stage, double fraction) {
      bar.update(stage, 0.8 * fraction);
    });
    bar.update("triangulation", 0.8);
    triangulation.threads = common.threads;
    triangles =
        allTriangles(triangulateSegments(points.view(), cloud.segmentation, triangulation, all));
  }
  Results results;
  results.normals = &cloud.normals;
  results.segmentation = &cloud.segmentation;
  results.triangles = &triangles;
  writeResults(table, results, file);
  file.commit();
  if (common.quiet) return 0;
  std::printf("points     %zu, %zu without normal\n", table.size, cloud.report.without_normal);
  std::printf("segments   %zu regular, %zu connected, %zu isolated\n",
              cloud.report.regular_segments, cloud.report.connected_segments,
              cloud.report.isolated_segments);
  std::printf("triangles  %zu\nwritten    %s\n", triangles.size(), file.path().c_str());
  return 0;
}

}  // namespace segorient::program
