// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "commands/commands.h"

#include <algorithm>
#include <cstdint>

#include "io/file_endings.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "render/cloud_page.h"
#include "render/scene.h"
#include "support/command_line.h"
#include "support/report_facts.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

// What is known of the cloud beyond its points.
class KnownOptions {
 public:
  void add(CommandLine& line) {
    line.options()("report", po::value(&report_),
                   "of orient: hard segments are violet, dark where they face away (colour "
                   "orientation); confidences of segments; contradictions are ringed")(
        "sensors", po::value(&sensors_),
        "places of sensors to mark: JSON of segorient sensors (what faces sure ones is right, if "
        "they saw all points), or a cloud; else as the file says (its place, or fields vp_x, vp_y, "
        "vp_z)");
  }
  Facts read(const CloudTable& table) const {
    Facts facts;
    if (!report_.empty()) facts = readReport(report_);
    const std::array<double, 3> own{table.viewpoint[0], table.viewpoint[1], table.viewpoint[2]};
    if (!sensors_.empty()) {
      std::size_t explained = 0;
      facts.sensors = readSensors(sensors_, &explained);
      facts.saw_all = 100 * explained >= 99 * table.size;
    } else if (own != std::array<double, 3>{0.0, 0.0, 0.0}) {
      facts.sensors = {own};
    } else {
      facts.sensors = sensorsOfPoints(table);
    }
    return facts;
  }

 private:
  std::string report_;
  std::string sensors_;
};

// A page is turned, and its colours are chosen, in the browser.
void warnOfOtherKind(const CommandLine& line, bool page) {
  if (page) {
    nameUnused(line, {"color", "azimuth", "elevation", "single", "width", "height"}, "of a page");
  } else {
    nameUnused(line, {"points"}, "of a picture");
  }
}

std::string baseName(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

void writeCloudPage(const PageCloud& cloud, const PageOptions& options, bool quiet,
                    OutputFile& out) {
  std::size_t bytes = 0;
  const std::size_t shown = writePage(cloud, options, [&](std::string_view text) {
    bytes += text.size();
    out.write(text);
  });
  out.commit();
  if (quiet) return;
  std::printf("%zu of %zu points, %.1f MB: %s\n", shown, cloud.points.size,
              static_cast<double>(bytes) / 1e6, out.path().c_str());
}

}  // namespace

int runRender(const std::vector<std::string>& words) {
  CommandLine line(
      "render IN OUT.png|OUT.html [options]",
      "OUT.png: a cloud as closed surfaces, from two opposite sides. Needs no screen.\n"
      "Colours by normal: light is the side that normals point to, brown the other where\n"
      "it may be seen, blue has no normal, and red is wrong: the normal points away from\n"
      "the side that shows. Which that is, is found by where points can be seen from all\n"
      "around; a closed object inside out is red all over. Of an open sheet either side\n"
      "may be the right one: red there is only what contradicts nearly all around it.\n"
      "Where fields vp_x, vp_y, vp_z say where points were seen from, they tell the right\n"
      "side; a scan from inside a closed room needs them. By orientation: the same with a\n"
      "tint for each segment, and hard ones marked: those that the report lists as decided\n"
      "by no method. A PLY with faces is drawn as the mesh that it is, its backs red.\n"
      "OUT.html: one file that any browser with WebGL 2 shows, to turn, cut and pick.",
      "segorient render oriented.pcd oriented.png --color normal");
  View view;
  std::string color;
  KnownOptions known;
  bool single = false;
  auto most = static_cast<std::int64_t>(PageOptions().points);  // -1 would be huge without a sign
  CommonOptions common;
  line.arguments({"IN", "OUT"});
  line.options()(
      "color", po::value(&color)->default_value("auto"),
      "auto, normal, orientation, segment (field label), confidence (field confidence, or "
      "--report), height, scan (field scan), rgb")(
      "azimuth", po::value(&view.azimuth)->default_value(view.azimuth), "degrees about the z axis")(
      "elevation", po::value(&view.elevation)->default_value(view.elevation),
      "degrees above the horizon")("single", po::bool_switch(&single), "one side only")(
      "width", po::value<std::size_t>(&view.width)->default_value(1600), "pixels")(
      "height", po::value<std::size_t>(&view.height)->default_value(800), "pixels")(
      "points", po::value(&most)->default_value(most),
      "of OUT.html: at most so many, spread evenly");
  known.add(line);
  takeSharedOptions(line);
  common.add(line);
  if (!line.parse(words)) return 0;
  require(view.width >= 2 && view.width <= 16384 && view.height >= 1 && view.height <= 16384,
          "--width and --height must be 2 to 16384");
  requireFinite(line, {"azimuth", "elevation"});
  common.check();
  warnOfSharedOptions(line, common);
  require(most >= 1, "--points must be at least 1");
  requireEnding(line.argument("OUT"), {".png", ".html"});
  const bool page = fileEnding(line.argument("OUT")) == ".html";
  if (!common.quiet) warnOfOtherKind(line, page);

  OutputFile out(line.argument("OUT"));
  const std::string path = line.argument("IN");
  const CloudTable table = readUsableCloud(path);
  const LocalPoints points(table);
  const Facts facts = known.read(table);
  if (page) {
    writeCloudPage(pageCloud(table, points, facts, baseName(path)),
                   {static_cast<std::size_t>(most), common.threads}, common.quiet, out);
    return 0;
  }
  const Coloring coloring = parseColoring(color, table, path, facts);
  const Scene scene = makeScene(table, points, nullptr, coloring, common.threads, facts);
  view.threads = common.threads;
  Picture picture = drawViews(scene, view, !single);
  drawLegend(Palette(table, coloring, facts).legend(shownSides(scene)), picture);
  writePng(picture, out);
  out.commit();
  return 0;
}

}  // namespace segorient::program
