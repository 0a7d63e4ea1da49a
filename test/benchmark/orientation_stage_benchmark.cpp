// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What the stage after segmentation costs, and whether its result depends on what it must not
// depend on, as Markdown tables.
//   orientation_stage_benchmark time [CLOUD.ply|.pcd ...]
//     All of section 3 of the paper (segment graph, triangulations where asked for, orientation) as
//     a multiple of our own all-points search for the same neighbours, in the same process, one
//     after the other, medians of five rounds; one thread and all. Always with a made-up cloud of a
//     million points on 14,400 small faces.
//   orientation_stage_benchmark invariance CLOUD.ply|.pcd ...
//     Points whose normal changes when the rows are shuffled, and when other numbers of threads are
//     used, by method; the whole pipeline, compared bit by bit.
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/common/impl/cloud_access.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "common/compact_cloud.h"
#include "features/local_normals.h"
#include "orientation/orient_segments.h"
#include "segmentation/region_growing.h"
#include "segmentation/segment_graph.h"

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using segorient::OrientationMethod;
using segorient::OrientationOptions;

struct Method {
  const char* title;
  OrientationOptions options;
};

std::vector<Method> methods() {
  std::vector<Method> out;
  const auto add = [&out](const char* title, OrientationMethod method) -> OrientationOptions& {
    out.push_back({title, {}});
    out.back().options.method = method;
    return out.back().options;
  };
  add("propagation", OrientationMethod::PROPAGATION);
  add("hoppe", OrientationMethod::HOPPE);
  add("boundary", OrientationMethod::BOUNDARY);
  add("boundary, triangulated", OrientationMethod::BOUNDARY).boundary =
      segorient::BoundaryTest::TRIANGULATED;
  add("extremal", OrientationMethod::EXTREMAL);
  add("combined", OrientationMethod::COMBINED);
  add("combined, triangulated", OrientationMethod::COMBINED).boundary =
      segorient::BoundaryTest::TRIANGULATED;
  return out;
}

bool load(const std::string& path, Cloud& cloud) {
  const bool pcd = path.size() > 4 && path.compare(path.size() - 4, 4, ".pcd") == 0;
  return (pcd ? pcl::io::loadPCDFile(path, cloud) : pcl::io::loadPLYFile(path, cloud)) == 0;
}

// A field of 60 x 60 pyramids on a slab.
Cloud manyFaces(std::size_t points) {
  constexpr int kPyramids = 60;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.F, static_cast<float>(kPyramids));
  Cloud cloud;
  while (cloud.size() < points) {
    const float x = unit(random);
    const float y = unit(random);
    const float from_ridge =
        std::min({x - std::floor(x), std::ceil(x) - x, y - std::floor(y), std::ceil(y) - y});
    cloud.push_back({x, y, 0.8F * from_ridge});
    if (cloud.size() % 3 == 0) cloud.push_back({x, y, -5.F});
  }
  return cloud;
}

template <typename Action>
double seconds(Action&& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

constexpr int kNeighbors = 12;  // as the pipeline takes on clean clouds
constexpr int kRounds = 5;

void timeStage(const std::string& name, const Cloud& cloud, int threads) {
  const segorient::CloudPoints<pcl::PointXYZ> points(cloud);
  const segorient::CompactCloud compact = segorient::compactCloud(points.view(), nullptr, threads);
  segorient::Neighborhoods neighborhoods;
  const auto search = [&] {
    segorient::search::MedianHashIndex index;
    segorient::search::MedianHashIndex::Options options;
    options.threads = threads;
    index.build(compact.view(), nullptr, options);
    index.nearestKAll(kNeighbors + 1, neighborhoods);
  };
  search();
  std::vector<float> normals(4 * compact.size());
  segorient::LocalNormalOptions normal_options;
  normal_options.k = 0;
  segorient::estimateNormals(compact.view(), neighborhoods, normal_options, normals.data());
  const segorient::NormalView normal_view{normals.data(), 4, compact.size()};
  const segorient::Segmentation segmentation =
      segorient::segmentByNormals(compact.view(), normal_view, neighborhoods, {});
  std::size_t regular = 0;
  for (const segorient::Segment& s : segmentation.segments) {
    regular += s.kind == segorient::SegmentKind::REGULAR ? 1 : 0;
  }

  const std::vector<Method> all = methods();
  std::vector<double> search_times;
  std::vector<std::vector<double>> times(all.size());
  for (int round = 0; round < kRounds; ++round) {
    search_times.push_back(seconds(search));
    for (std::size_t m = 0; m < all.size(); ++m) {
      OrientationOptions options = all[m].options;
      options.threads = threads;
      times[m].push_back(seconds([&] {
        segorient::orientSegments(compact.view(), normal_view, neighborhoods, segmentation,
                                  options);
      }));
    }
  }
  const std::string file = name.substr(name.find_last_of('/') + 1);
  std::printf("| %s | %zu | %zu | %s | %.3f |", file.c_str(), compact.size(), regular,
              threads == 1 ? "1" : "all", median(search_times));
  for (const std::vector<double>& t : times)
    std::printf(" %.2f |", median(t) / median(search_times));
  std::printf("\n");
  std::fflush(stdout);
}

int runTime(const std::vector<std::string>& paths) {
  std::printf("| cloud | points | regular segments | threads | search, s |");
  for (const Method& m : methods()) std::printf(" %s |", m.title);
  std::printf("\n|---|---|---|---|---|");
  for (std::size_t i = 0; i < methods().size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const int threads : {1, 0}) timeStage("pyramids", manyFaces(1000000), threads);
  for (const std::string& path : paths) {
    Cloud cloud;
    if (!load(path, cloud)) return 1;
    for (const int threads : {1, 0}) timeStage(path, cloud, threads);
  }
  return 0;
}

std::size_t countDifferent(const std::vector<float>& a, const std::vector<float>& b,
                           const std::vector<std::size_t>& row_in_b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < row_in_b.size(); ++i) {
    count += std::memcmp(&a[4 * i], &b[4 * row_in_b[i]], 4 * sizeof(float)) != 0 ? 1 : 0;
  }
  return count;
}

// Points that differ: shuffled, and with other numbers of threads.
std::pair<std::size_t, std::size_t> countDependent(const Cloud& cloud,
                                                   const OrientationOptions& orientation) {
  segorient::PipelineOptions options;
  options.orientation = orientation;
  const segorient::CloudPoints<pcl::PointXYZ> points(cloud);
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<float> first = orientCloud(points.view(), nullptr, options).normals;
  std::size_t by_threads = 0;
  for (const int threads : {1, 3}) {
    options.threads = threads;
    const std::vector<float> other = orientCloud(points.view(), nullptr, options).normals;
    by_threads = std::max(by_threads, countDifferent(first, other, order));
  }
  options.threads = 0;
  std::mt19937 random(5);
  std::shuffle(order.begin(), order.end(), random);  // row i goes to order[i]
  Cloud shuffled = cloud;
  for (std::size_t i = 0; i < cloud.size(); ++i) shuffled[order[i]] = cloud[i];
  const segorient::CloudPoints<pcl::PointXYZ> shuffled_points(shuffled);
  const std::vector<float> other = orientCloud(shuffled_points.view(), nullptr, options).normals;
  return {countDifferent(first, other, order), by_threads};
}

int runInvariance(const std::vector<std::string>& paths) {
  std::vector<Method> all = methods();
  all.push_back({"auto", {}});
  std::printf("Points whose normal differs after shuffling the rows / with 1 or 3 threads.\n\n");
  std::printf("| cloud | points |");
  for (const Method& m : all) std::printf(" %s |", m.title);
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < all.size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const std::string& path : paths) {
    Cloud cloud;
    if (!load(path, cloud)) return 1;
    std::printf("| %s | %zu |", path.substr(path.find_last_of('/') + 1).c_str(), cloud.size());
    for (const Method& m : all) {
      const auto [by_order, by_threads] = countDependent(cloud, m.options);
      std::printf(" %zu / %zu |", by_order, by_threads);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const std::vector<std::string> paths(argv + std::min(argc, 2), argv + argc);
  if (what == "time") return runTime(paths);
  if (what == "invariance" && !paths.empty()) return runInvariance(paths);
  std::fprintf(stderr,
               "usage: orientation_stage_benchmark time [CLOUD ...]\n"
               "       orientation_stage_benchmark invariance CLOUD ...\n");
  return 2;
}
