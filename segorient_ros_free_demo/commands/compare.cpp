// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <segorient/orientation/pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "commands/commands.h"
#include "common/threads.h"
#include "io/cloud_writer.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "render/scene.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/pcl_limits.h"
#include "support/poisson.h"
#include "support/progress_bar.h"
#include "support/sensor_report.h"
#include "support/stage_options.h"
#include "support/stopwatch.h"
#include "support/true_surface.h"
#include "support/two_normals.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

struct PclResult {
  Normals normals;
  double search = 0.0;  // seconds
  double estimation = 0.0;
};

// As most PCL programs do it: k neighbours by KdTree, turned towards the viewpoint.
PclResult runPcl(const PointView& points, const std::array<float, 3>& viewpoint, int k,
                 int threads) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isFinite(points[i])) continue;
    cloud->push_back({points[i][0], points[i][1], points[i][2]});
    rows.push_back(i);
  }
  PclResult out;
  const Stopwatch search_time;
  const auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
  tree->setInputCloud(cloud);
  out.search = search_time.seconds();
  const Stopwatch estimation_time;
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(static_cast<unsigned>(threads));
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(tree);
  estimation.setKSearch(k);
  estimation.setViewPoint(viewpoint[0], viewpoint[1], viewpoint[2]);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  out.estimation = estimation_time.seconds();
  out.normals.assign(4 * points.size, NAN);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy_n(normals[i].normal, 3, &out.normals[4 * rows[i]]);
    out.normals[4 * rows[i] + 3] = normals[i].curvature;
  }
  return out;
}

void printAgainstTruth(const char* name, const Normals& truth, const Normals& normals) {
  const Difference d = compareNormals(truth, normals);
  std::printf(
      "  %-10s %.3f %% oriented alike (%.3f %% after a global flip), angle rms %.2f median %.2f "
      "deg\n",
      name, d.share(d.compared - d.opposite),
      d.share(std::max(d.opposite, d.compared - d.opposite)), d.rms, d.median);
}

bool knowsViewpoint(const OrientationHints& hints) {
  return hints.has_viewpoint && isFinite(hints.viewpoint.data());
}

// What PCL's normals were turned to, and how far both face it.
void printSensors(const PointView& points, const OrientationHints& hints, const Normals& pcl,
                  const Normals& ours) {
  const bool own = !hints.viewpoints.empty();
  if (!own && !hints.has_direction && !knowsViewpoint(hints)) {
    std::printf("viewpoint   not known; PCL took the origin\n");
    return;
  }
  std::printf("viewpoint   %s, for both: PCL %.3f %%, ours %.3f %% of the points face it\n",
              own                   ? "each point's own"
              : hints.has_direction ? "far above"
                                    : "one for all",
              shareFacing(points, hints, pcl), shareFacing(points, hints, ours));
}

void print(const CloudTable& table, const PipelineReport& report, const PclResult& pcl_result,
           const Normals& our_normals) {
  const Difference d = compareNormals(pcl_result.normals, our_normals);
  std::printf("points      %zu; %d neighbours\n", table.size, report.k);
  std::printf("seconds     PCL %.2f: search %.2f  normals and viewpoint %.2f\n",
              pcl_result.search + pcl_result.estimation, pcl_result.search, pcl_result.estimation);
  std::printf("            ours %.2f: %s\n", report.seconds, timesText(report.stages).c_str());
  std::printf("angle       median %.3f  p90 %.3f deg between the two, signs ignored\n", d.median,
              d.p90);
  std::printf("orientation %.3f %% of %zu points differ\n", d.share(d.opposite), d.compared);
  if (table.hasNormals()) {
    const Normals truth = ownNormals(table);
    std::printf("against the input's own normals:\n");
    printAgainstTruth("PCL", truth, pcl_result.normals);
    printAgainstTruth("segorient", truth, our_normals);
  }
}

Picture pictureOf(const CloudTable& table, const LocalPoints& points, const Normals& normals,
                  const View& view, const char* title) {
  const Scene scene = makeScene(table, points, normals.data(), Coloring::Normal, view.threads, {});
  Picture picture = drawScene(scene, view);
  drawTitle(title, picture);
  Legend legend;
  if (shownSides(scene).wrong) legend.keys.emplace_back(kWrongSide, "wrong side");
  drawLegend(legend, picture);
  return picture;
}

// PCL's viewpoint is 0, 0, 0 unless it is told otherwise.
std::array<float, 3> viewpointOf(const LocalPoints& points, const OrientationHints& hints) {
  std::array<float, 3> viewpoint = hints.viewpoint;
  for (std::size_t a = 0; a < 3 && !knowsViewpoint(hints); ++a) {
    viewpoint[a] = static_cast<float>(-points.origin()[a]);
  }
  return viewpoint;
}

// What pcl::Poisson makes of both.
struct PoissonOptions {
  std::string prefix;  // of the files; empty: it is left out
  int depth = 0;
  std::string truth_path;  // empty: the cloud itself
};

struct Both {
  OrientedCloud ours;
  PclResult pcl;
  std::string poisson_text;
};

Both runBoth(const CloudTable& table, const LocalPoints& points, const PipelineOptions& options,
             const PoissonOptions& poisson, const CommonOptions& common) {
  Both both;
  ProgressBar bar(!common.quiet, table.size);
  const double share = poisson.prefix.empty() ? 0.5 : 0.3;
  both.ours = orientCloud(points.view(), nullptr, options, [&](const char* stage, double fraction) {
    bar.update(stage, share * fraction);
  });
  bar.update("PCL", share);
  const OrientationHints& hints = *options.orientation.hints;
  // PCL counts the point itself.
  both.pcl = runPcl(points.view(), viewpointOf(points, hints), both.ours.report.k + 1,
                    resolveThreads(common.threads));
  turnToOwnSensors(points.view(), hints, both.pcl.normals);
  if (poisson.prefix.empty()) return both;
  bar.update("poisson", 2.0 * share);
  const TrueSurface truth(poisson.truth_path.empty() ? table : readUsableCloud(poisson.truth_path),
                          points.origin(), common.threads);
  both.poisson_text = comparePoisson(points, {both.pcl.normals, both.ours.normals}, poisson.depth,
                                     poisson.prefix, truth, bar);
  return both;
}

}  // namespace

int runCompare(const std::vector<std::string>& words) {
  CommandLine line(
      "compare IN [options]",
      "Normals of pcl::NormalEstimationOMP, turned to the sensor, beside those of\n"
      "segorient orient: time, angles, share of points oriented differently; and both\n"
      "against IN's own normals if it has any. Both know the same sensors: what IN says\n"
      "(VIEWPOINT, vp_x vp_y vp_z, poses) or an option; if nothing does, PCL takes the\n"
      "origin, as it does by default. Pictures show PCL left, ours right.",
      "segorient compare scan.ply --picture compare.png --poisson poisson");
  CommonOptions common;
  StageOptions stages;
  HintOptions hints;
  std::string picture_path;
  View view;
  PoissonOptions poisson;
  line.arguments({"IN"});
  stages.add(line, LastStage::ORIENTATION);
  hints.add(line);
  line.options()("picture", po::value(&picture_path), "PNG: PCL left, ours right")(
      "azimuth", po::value(&view.azimuth)->default_value(view.azimuth), "of the picture, degrees")(
      "elevation", po::value(&view.elevation)->default_value(view.elevation), "above the horizon")(
      "poisson", po::value(&poisson.prefix),
      "surfaces of pcl::Poisson from both: writes NAME_pcl.ply, NAME_ours.ply, NAME.png")(
      "depth", po::value(&poisson.depth)->default_value(8), "of pcl::Poisson's octree")(
      "truth", po::value(&poisson.truth_path),
      "the true surface, to measure those of pcl::Poisson by: a mesh, or a cloud with normals; "
      "left out: IN, if it has normals");
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  requireFinite(line, {"azimuth", "elevation"});
  require(poisson.depth >= 2 && poisson.depth <= 14, "--depth must be 2 to 14");
  PipelineOptions options;
  stages.apply(line, common, options);
  hints.check(line, common, options);
  stages.warnOfUnused(line, common, options);
  if (!common.quiet) {
    if (picture_path.empty()) nameUnused(line, {"azimuth", "elevation"}, "without --picture");
    if (poisson.prefix.empty()) nameUnused(line, {"depth", "truth"}, "without --poisson");
  }
  std::optional<OutputFile> picture;
  if (!picture_path.empty()) {
    requireEnding(picture_path, {".png"});
    picture.emplace(picture_path);
  }

  const CloudTable table = hints.read({line.argument("IN")}, common.quiet);
  const LocalPoints points(table);
  requirePclRange(points, line.argument("IN"));
  hints.apply(table, line.argument("IN"), points, options);
  const Both both = runBoth(table, points, options, poisson, common);
  if (!common.quiet) {
    print(table, both.ours.report, both.pcl, both.ours.normals);
    printSensors(points.view(), *options.orientation.hints, both.pcl.normals, both.ours.normals);
    constexpr int kColumn = 14;  // the line's name is longer than others
    printNotFollowed(both.ours.report.known_sensors, points.origin(), kColumn);
  }
  if (picture) {
    view.threads = common.threads;
    writePng(beside({pictureOf(table, points, both.pcl.normals, view, "PCL"),
                     pictureOf(table, points, both.ours.normals, view, "segorient")}),
             *picture);
    picture->commit();
    if (!common.quiet) std::printf("written     %s\n", picture_path.c_str());
  }
  if (!common.quiet) std::fputs(both.poisson_text.c_str(), stdout);
  return 0;
}

}  // namespace segorient::program
