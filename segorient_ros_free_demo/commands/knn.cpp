// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <omp.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <segorient/search/median_hash.h>

#include <cmath>
#include <cstdio>
#include <optional>

#include "commands/commands.h"
#include "common/threads.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/pcl_limits.h"
#include "support/progress_bar.h"
#include "support/stage_options.h"
#include "support/stopwatch.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

struct Timing {
  double build = 0.0;
  double query = 0.0;
};

// The finite points, and where each stood in the input.
Cloud::Ptr finitePoints(const PointView& points, std::vector<std::size_t>& rows) {
  Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isFinite(points[i])) continue;
    cloud->push_back({points[i][0], points[i][1], points[i][2]});
    rows.push_back(i);
  }
  return cloud;
}

Timing searchByHash(const Cloud::Ptr& cloud, int k, int threads, Neighborhoods& out) {
  Timing timing;
  search::MedianHash<pcl::PointXYZ> index;
  index.setNumberOfThreads(static_cast<unsigned>(threads));
  const Stopwatch build;
  index.setInputCloud(cloud);
  timing.build = build.seconds();
  const Stopwatch query;
  index.nearestKSearchAll(k, out);
  timing.query = query.seconds();
  return timing;
}

// A loop of single queries, as PCL's classes run it; `differing` counts distances unlike ours.
Timing searchByKdTree(const Cloud::Ptr& cloud, int k, int threads, const Neighborhoods& ours,
                      std::size_t& differing) {
  Timing timing;
  pcl::search::KdTree<pcl::PointXYZ> tree;
  const Stopwatch build;
  tree.setInputCloud(cloud);
  timing.build = build.seconds();
  const Stopwatch query;
  std::size_t unlike = 0;
#pragma omp parallel num_threads(threads) reduction(+ : unlike)
  {
    pcl::Indices indices;
    std::vector<float> distances;
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      const int found = tree.nearestKSearch((*cloud)[i], k, indices, distances);
      unlike += found != ours.count(i) ? 1 : 0;
      for (int j = 0; j < found && j < ours.count(i); ++j) {
        const float a = distances[static_cast<std::size_t>(j)];
        const float b = ours.sqrDistances(i)[j];
        if (std::abs(a - b) > 1e-5F * a) ++unlike;
      }
    }
  }
  timing.query = query.seconds();
  differing = unlike;
  return timing;
}

void writeCsv(const Neighborhoods& neighborhoods, const std::vector<std::size_t>& rows,
              OutputFile& file) {
  file.write("point,rank,neighbor,distance\n");
  std::string text;
  char number[40];
  for (std::size_t i = 0; i < neighborhoods.size(); ++i) {
    text.clear();
    for (int j = 0; j < neighborhoods.count(i); ++j) {
      const auto neighbor = static_cast<std::size_t>(neighborhoods.indices(i)[j]);
      std::snprintf(number, sizeof(number), "%.9g",
                    std::sqrt(static_cast<double>(neighborhoods.sqrDistances(i)[j])));
      text += std::to_string(rows[i]) + ',' + std::to_string(j) + ',' +
              std::to_string(rows[neighbor]) + ',' + number + '\n';
    }
    file.write(text);
  }
}

void printTiming(const char* name, const Timing& timing, std::size_t points) {
  std::printf("%-22s build %8.4f s   queries %8.4f s   %8.1f ns a point\n", name, timing.build,
              timing.query, 1e9 * (timing.build + timing.query) / static_cast<double>(points));
}

}  // namespace

int runKnn(const std::vector<std::string>& words) {
  CommandLine line(
      "knn IN [OUT.csv] [options]",
      "Finds the k nearest neighbours of every point of IN, the point itself first, and\n"
      "says how long that took; the same by pcl::search::KdTree beside it, point by\n"
      "point. OUT.csv has a line a neighbour: point, rank, neighbor, distance.",
      "segorient knn scan.ply neighbors.csv -k 10");
  CommonOptions common;
  int k = 0;
  bool alone = false;
  line.arguments({"IN", "OUT.csv"}, 1);
  line.options()("neighbors,k", po::value(&k)->default_value(15), "neighbours, the point included")(
      "alone", po::bool_switch(&alone), "without pcl::search::KdTree");
  takeSharedOptions(line, false);
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  warnOfSharedOptions(line, common, false);
  require(k > 0 && k <= 1000, "-k must be 1 to 1000");
  const std::string out = line.argument("OUT.csv");
  std::optional<OutputFile> file;
  if (!out.empty()) {
    requireEnding(out, {".csv"});
    file.emplace(out);
  }

  const CloudTable table = readUsableCloud(line.argument("IN"));
  std::vector<std::size_t> rows;
  const LocalPoints points(table);
  requirePclRange(points, line.argument("IN"));
  const Cloud::Ptr cloud = finitePoints(points.view(), rows);
  const int threads = resolveThreads(common.threads);
  Neighborhoods neighborhoods;
  Timing ours;
  Timing pcl_timing;
  std::size_t differing = 0;
  const bool both = !alone && !common.quiet;
  {
    ProgressBar bar(!common.quiet, cloud->size());
    bar.update("search", 0.0);
    ours = searchByHash(cloud, k, threads, neighborhoods);
    if (both) {
      bar.update("PCL", 0.2);
      pcl_timing = searchByKdTree(cloud, k, threads, neighborhoods, differing);
    }
  }
  if (!common.quiet) {
    std::printf("points                 %zu finite of %zu; k = %d, threads = %d\n", cloud->size(),
                table.size, k, threads);
    printTiming("search::MedianHash", ours, cloud->size());
  }
  if (both) {
    printTiming("pcl::search::KdTree", pcl_timing, cloud->size());
    std::printf("queries                %.2f times as fast; %zu distances differ\n",
                pcl_timing.query / ours.query, differing);
  }
  if (file) {
    writeCsv(neighborhoods, rows, *file);
    file->commit();
    if (!common.quiet) std::printf("written                %s\n", out.c_str());
  }
  return 0;
}

}  // namespace segorient::program
