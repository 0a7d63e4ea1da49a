// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/point_types.h>
#include <pcl/visualization/pcl_visualizer.h>

#include <cmath>
#include <cstdlib>

#include "commands/commands.h"
#include "io/readers.h"
#include "render/scene.h"
#include "support/command_line.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZRGBNormal>;

// The scene's points with the colours of their fronts; NaN normals where there are none.
Cloud::Ptr cloudOf(const Scene& scene) {
  Cloud::Ptr cloud(new Cloud);
  const auto add = [&](const std::array<float, 3>& position, const std::array<float, 3>& normal,
                       std::uint32_t rgb) {
    pcl::PointXYZRGBNormal p;
    std::copy_n(position.data(), 3, p.data);
    std::copy_n(normal.data(), 3, p.normal);
    p.r = static_cast<std::uint8_t>(rgb >> 16);
    p.g = static_cast<std::uint8_t>(rgb >> 8);
    p.b = static_cast<std::uint8_t>(rgb);
    cloud->push_back(p);
  };
  for (const Splat& s : scene.splats) add(s.position, s.normal, s.front);
  for (const auto& v : scene.vertices) add(v, {NAN, NAN, NAN}, 0xffffffU);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    for (const std::uint32_t v : scene.triangles[i]) {
      (*cloud)[v].r = static_cast<std::uint8_t>(scene.front[i] >> 16);
      (*cloud)[v].g = static_cast<std::uint8_t>(scene.front[i] >> 8);
      (*cloud)[v].b = static_cast<std::uint8_t>(scene.front[i]);
    }
  }
  return cloud;
}

void show(const Scene& scene, int every, double length) {
  pcl::visualization::PCLVisualizer viewer("segorient");
  const Cloud::Ptr cloud = cloudOf(scene);
  const pcl::visualization::PointCloudColorHandlerRGBField<pcl::PointXYZRGBNormal> colors(cloud);
  if (scene.triangles.empty()) {
    viewer.addPointCloud<pcl::PointXYZRGBNormal>(cloud, colors, "cloud");
    viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, 3,
                                            "cloud");
  } else {
    std::vector<pcl::Vertices> polygons(scene.triangles.size());
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      polygons[i].vertices.assign(scene.triangles[i].begin(), scene.triangles[i].end());
    }
    viewer.addPolygonMesh<pcl::PointXYZRGBNormal>(cloud, polygons, "mesh");
  }
  const bool normals = !scene.splats.empty() && every > 0;
  if (normals) {
    viewer.addPointCloudNormals<pcl::PointXYZRGBNormal>(cloud, every, static_cast<float>(length),
                                                        "normals");
  }
  viewer.resetCamera();
  viewer.spin();
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
  line.options()("color", po::value(&color)->default_value("auto"),
                 "auto (segment, else rgb), normal, segment, rgb")(
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
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0') {
    throw FileError(path,
                    "there is no screen to show it on (DISPLAY is not set); see segorient render");
  }
  const LocalPoints points(table);
  show(makeScene(table, points, nullptr, coloring, common.threads), every, 0.02 * points.extent());
  return 0;
}

}  // namespace segorient::program
