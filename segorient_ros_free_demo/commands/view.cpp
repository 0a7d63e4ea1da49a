// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <cstdlib>

#include "commands/commands.h"
#include "io/readers.h"
#include "render/scene.h"
#include "render/vtk/vtk_module.h"
#include "support/command_line.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

void requireScreen(const std::string& path) {
  const char* display = std::getenv("DISPLAY");
  std::string reason;
  if (display == nullptr || *display == '\0') {
    reason = "DISPLAY is not set";
  } else if (!vtkModule().has_screen()) {
    reason = "DISPLAY is " + std::string(display) + ", which cannot be reached";
  } else {
    return;
  }
  throw FileError(path, "there is no screen to show it on (" + reason + "); see segorient render");
}

}  // namespace

int runView(const std::vector<std::string>& words) {
  CommandLine line(
      "view IN [options]",
      "Shows a cloud, or the mesh in a PLY with faces, in a window of PCL's viewer: points\n"
      "in their colours, and normals as lines. Needs a screen; segorient render does not.",
      "segorient view oriented.pcd --color segment");
  std::string color;
  int every = 0;
  CommonOptions common;
  line.arguments({"IN"});
  line.options()(
      "color", po::value(&color)->default_value("auto"),
      "auto (segment, else rgb, else normal), normal, orientation, segment (field label), "
      "confidence (field confidence), height, scan (field scan), rgb")(
      "every", po::value(&every)->default_value(10), "a line at one of so many normals; 0 = none");
  takeSharedOptions(line);
  common.take(line);
  if (!line.parse(words)) return 0;
  common.check();
  warnOfSharedOptions(line, common);
  require(every >= 0, "--every must not be negative");

  const std::string path = line.argument("IN");
  const CloudTable table = readUsableCloud(path);
  if (color == "auto") {
    color = table.find("label") != nullptr ? "segment"
            : table.find("rgb") != nullptr ? "rgb"
                                           : "auto";
  }
  const Coloring coloring = parseColoring(color, table, path);
  requireScreen(path);
  const LocalPoints points(table);
  vtkModule().show(makeScene(table, points, nullptr, coloring, common.threads), every,
                   0.02 * points.extent());
  return 0;
}

}  // namespace segorient::program
