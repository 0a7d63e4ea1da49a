// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Segmentation beside pcl::RegionGrowing on solids with known faces, in one run and with the same
// normals, and the triangulation of segments.
//   segmentation_benchmark quality [POINTS]     adjusted Rand index, purity, coverage, segments a
//                                               face; noise of 0, 0.1 and 0.25 spacings
//   segmentation_benchmark speed [POINTS]       CPU time of one thread, beside the all-points
//   search segmentation_benchmark stability [POINTS]   the same cloud rotated and shuffled
//   segmentation_benchmark plate [POINTS]       both sides of thin plates
//   segmentation_benchmark surface [POINTS...]  triangulated area, holes and boundaries of solids
//   segmentation_benchmark growth               time and memory of one segment's triangulation
//   segmentation_benchmark FILE...              coverage and triangulation of clouds (pcd, ply)
#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/search/kdtree.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/surface/segment_mesh.h>
#include <pcl/segmentation/impl/region_growing.hpp>
#include <segorient/common/impl/cloud_access.hpp>
#include <segorient/segmentation/impl/cloud_segmentation.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <new>
#include <numeric>
#include <set>
#include <string>

#include "../support/labelled_solids.h"
#include "../support/partition_quality.h"
#include "common/compact_cloud.h"
#include "features/local_normals.h"
#include "segmentation/region_growing.h"

namespace {
std::atomic<std::size_t> live_bytes{0};
std::atomic<std::size_t> peak_bytes{0};
}  // namespace

// Counts what is allocated: exact where one thread runs.
void* operator new(std::size_t size) {
  void* p = std::malloc(size + sizeof(std::max_align_t));
  if (p == nullptr) throw std::bad_alloc();
  *static_cast<std::size_t*>(p) = size;
  const std::size_t live = live_bytes += size;
  if (live > peak_bytes) peak_bytes = live;
  return static_cast<char*>(p) + sizeof(std::max_align_t);
}
void operator delete(void* p) noexcept {
  if (p == nullptr) return;
  void* begin = static_cast<char*>(p) - sizeof(std::max_align_t);
  live_bytes -= *static_cast<std::size_t*>(begin);
  std::free(begin);
}
void operator delete(void* p, std::size_t) noexcept {
  operator delete(p);
}

namespace {

using namespace segorient;
using namespace segorient::test;

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

PointView viewOf(const std::vector<float>& rows) {
  return {rows.data(), 4, rows.size() / 4};
}

// Rows of normal and curvature.
NormalView normalsOf(const std::vector<float>& rows) {
  return {rows.data(), 4, rows.size() / 4};
}

Neighborhoods search(const std::vector<float>& xyz, int k, double* seconds = nullptr) {
  search::MedianHashIndex::Options options;
  options.threads = 1;
  const double start = cpuSeconds();
  search::MedianHashIndex index;
  index.build(viewOf(xyz), nullptr, options);
  Neighborhoods table;
  index.nearestKAll(k + 1, table);
  if (seconds != nullptr) *seconds = cpuSeconds() - start;
  return table;
}

std::vector<float> planeNormals(const std::vector<float>& xyz, const Neighborhoods& table, int k) {
  std::vector<float> normals(xyz.size());
  LocalNormalOptions options;
  options.k = k;
  options.threads = 1;
  estimateNormals(viewOf(xyz), table, options, normals.data());
  return normals;
}

CloudSegmentation segment(const std::vector<float>& xyz, const std::vector<float>& normals, int k,
                          const SegmentationOptions& options = {}) {
  CloudSegmentation::Input input;
  input.points = viewOf(xyz);
  input.normals = normalsOf(normals);
  input.neighbors = k;
  input.unite_smooth = true;
  CloudSegmentation result;
  result.compute(input, options);
  return result;
}

struct PclClouds {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points{new pcl::PointCloud<pcl::PointXYZ>};
  pcl::PointCloud<pcl::Normal>::Ptr normals{new pcl::PointCloud<pcl::Normal>};
};

PclClouds toPcl(const std::vector<float>& xyz, const std::vector<float>& normals) {
  PclClouds clouds;
  for (std::size_t i = 0; i < xyz.size(); i += 4) {
    clouds.points->emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
    clouds.normals->emplace_back(normals[i], normals[i + 1], normals[i + 2], normals[i + 3]);
  }
  return clouds;
}

std::vector<std::int32_t> regionGrowing(const PclClouds& clouds, int k, double degrees,
                                        double curvature, double* seconds = nullptr) {
  pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal> growing;
  growing.setInputCloud(clouds.points);
  growing.setInputNormals(clouds.normals);
  growing.setSearchMethod(
      pcl::search::Search<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  growing.setNumberOfNeighbours(static_cast<unsigned int>(k));
  growing.setSmoothnessThreshold(static_cast<float>(degrees * M_PI / 180));
  growing.setCurvatureThreshold(static_cast<float>(curvature));
  growing.setMinClusterSize(20);
  std::vector<pcl::PointIndices> clusters;
  const double start = cpuSeconds();
  growing.extract(clusters);
  if (seconds != nullptr) *seconds = cpuSeconds() - start;
  std::vector<std::int32_t> labels(clouds.points->size(), -1);
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (const auto i : clusters[c].indices)
      labels[static_cast<std::size_t>(i)] = static_cast<int>(c);
  }
  return labels;
}

// Labels of regular segments only.
std::vector<std::int32_t> regularLabels(const Segmentation& s) {
  std::vector<std::int32_t> labels = s.labels;
  for (auto& label : labels) {
    if (label >= 0 && s.segments[static_cast<std::size_t>(label)].kind != SegmentKind::REGULAR)
      label = -1;
  }
  return labels;
}

void print(const char* what, const std::vector<std::int32_t>& labels, const LabelledCloud& cloud) {
  const std::set<std::int32_t> segments(labels.begin(), labels.end());
  const std::set<int> faces(cloud.face.begin(), cloud.face.end());
  const auto covered =
      std::count_if(labels.begin(), labels.end(), [](std::int32_t l) { return l >= 0; });
  std::printf(" | %s ARI %.4f purity %.4f cover %.4f segments/face %.2f", what,
              adjustedRandIndex(labels, cloud.face), purity(labels, cloud.face),
              static_cast<double>(covered) / static_cast<double>(labels.size()),
              static_cast<double>(segments.size() - segments.count(-1)) /
                  static_cast<double>(faces.size()));
}

std::vector<std::pair<std::string, std::vector<Face>>> solids() {
  return {{"cube", cube()},
          {"octagonal prism", octagonalPrism()},
          {"stepped", steppedSolid()},
          {"bracket", bracket()},
          {"holed", holedSolid()},
          {"cylinder", cylinder()}};
}

void quality(std::size_t n) {
  for (const double sigma : {0.0, 0.1, 0.25}) {
    const int k = sigma > 0.2 ? 18 : 12;
    for (const auto& [name, faces] : solids()) {
      const LabelledCloud cloud = sample(name, faces, n, 101, sigma);
      const std::vector<float> normals = planeNormals(cloud.xyz, search(cloud.xyz, k), k);
      std::printf("%-16s %zu points, sigma %.2f h", name.c_str(), n, sigma);
      const CloudSegmentation ours = segment(cloud.xyz, normals, 12);
      print("faces", regularLabels(ours.faces()), cloud);
      print("segments", regularLabels(ours.segmentation()), cloud);
      const PclClouds clouds = toPcl(cloud.xyz, normals);
      double best = -1;
      std::vector<std::int32_t> best_labels;
      std::string best_name;
      for (const int neighbors : {12, 30}) {
        for (const double degrees : {1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0}) {
          for (const double curvature : {0.02, 0.05, 1.0}) {
            auto labels = regionGrowing(clouds, neighbors, degrees, curvature);
            const double index = adjustedRandIndex(labels, cloud.face);
            if (index <= best) continue;
            best = index;
            best_labels = std::move(labels);
            best_name = "PCL k " + std::to_string(neighbors) + " angle " +
                        std::to_string(static_cast<int>(degrees)) + " curvature " +
                        std::to_string(curvature).substr(0, 4);
          }
        }
      }
      print(best_name.c_str(), best_labels, cloud);
      std::printf("\n");
      std::fflush(stdout);
    }
  }
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void speed(std::size_t n) {
  for (const auto& [name, faces] : {solids()[0], solids()[5]}) {
    const LabelledCloud raw = sample(name, faces, n, 7);
    const CompactCloud cloud = compactCloud(viewOf(raw.xyz), nullptr, 1);
    const std::vector<float> xyz(cloud.xyz.begin(), cloud.xyz.end());
    for (const int k : {10, 15}) {
      std::vector<double> search_times;
      std::vector<double> times;
      std::vector<double> face_times;
      std::vector<float> normals;
      SegmentationOptions options;
      options.threads = 1;
      for (int run = 0; run < 5; ++run) {
        double seconds = 0;
        const Neighborhoods table = search(xyz, k, &seconds);
        search_times.push_back(seconds);
        normals = planeNormals(xyz, table, k);
        const double start = cpuSeconds();
        const Segmentation s = segmentByNormals(cloud.view(), normalsOf(normals), table, options);
        times.push_back(cpuSeconds() - start);
        const double again = cpuSeconds();
        Segmentation united;
        segmentByNormals(cloud.view(), normalsOf(normals), table, options, nullptr, &united);
        face_times.push_back(cpuSeconds() - again);
      }
      double theirs = 0;
      regionGrowing(toPcl(xyz, normals), k, 8, 0.05, &theirs);
      const double search_time = medianOf(search_times);
      const double time = medianOf(face_times);
      std::printf(
          "%-10s %zu points, k = %d: search %.3f s, segments %.2f of it, faces %.2f; RegionGrowing "
          "%.1f times our faces\n",
          name.c_str(), n, k, search_time, medianOf(times) / search_time, time / search_time,
          theirs / time);
      std::fflush(stdout);
    }
  }
}

void stability(std::size_t n) {
  for (const double sigma : {0.0, 0.25}) {
    const int k = sigma > 0.2 ? 18 : 12;
    for (const auto& [name, faces] : solids()) {
      const LabelledCloud cloud = sample(name, faces, n, 11, sigma);
      const auto run = [&](const std::vector<float>& xyz) {
        return segment(xyz, planeNormals(xyz, search(xyz, k), k), 12).faces().labels;
      };
      const std::vector<std::int32_t> before = run(cloud.xyz);
      double worst = 1;
      double worst_pcl = 1;
      const auto runPcl = [&](const std::vector<float>& xyz) {
        return regionGrowing(toPcl(xyz, planeNormals(xyz, search(xyz, k), k)), 30, 6, 0.05);
      };
      const std::vector<std::int32_t> before_pcl = runPcl(cloud.xyz);
      for (unsigned turn = 1; turn <= 5; ++turn) {
        std::vector<std::size_t> order(n);
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), std::mt19937(turn));
        const Eigen::Matrix3f rotation = Eigen::AngleAxisf(0.7F * static_cast<float>(turn),
                                                           Eigen::Vector3f(1, 2, 3).normalized())
                                             .toRotationMatrix();
        std::vector<float> xyz(4 * n, 0.F);
        for (std::size_t i = 0; i < n; ++i) {
          const Eigen::Vector3f turned =
              rotation * Eigen::Map<const Eigen::Vector3f>(&cloud.xyz[4 * order[i]]);
          std::copy_n(turned.data(), 3, &xyz[4 * i]);
        }
        const auto back = [&](const std::vector<std::int32_t>& labels) {
          std::vector<std::int32_t> result(n);
          for (std::size_t i = 0; i < n; ++i) result[order[i]] = labels[i];
          return result;
        };
        worst = std::min(worst, adjustedRandIndex(before, back(run(xyz))));
        worst_pcl = std::min(worst_pcl, adjustedRandIndex(before_pcl, back(runPcl(xyz))));
      }
      std::printf("%-16s %zu points, sigma %.2f h: worst ARI of 5 turns %.4f, RegionGrowing %.4f\n",
                  name.c_str(), n, sigma, worst, worst_pcl);
      std::fflush(stdout);
    }
  }
}

void plates(std::size_t n) {
  for (const double thickness : {1.0, 1.5, 2.0, 3.0, 4.0}) {
    for (const double sigma : {0.0, 0.1}) {
      double worst = 1;
      double covered = 1;
      for (unsigned seed = 1; seed <= 5; ++seed) {
        const LabelledCloud cloud = sample("plate", plate(thickness, n), n, seed, sigma);
        const std::vector<float> normals = planeNormals(cloud.xyz, search(cloud.xyz, 12), 10);
        const CloudSegmentation ours = segment(cloud.xyz, normals, 12);
        std::vector<std::int32_t> labels = ours.faces().labels;
        const auto regular = regularLabels(ours.segmentation());
        covered =
            std::min(covered, static_cast<double>(std::count_if(regular.begin(), regular.end(),
                                                                [](int l) { return l >= 0; })) /
                                  static_cast<double>(n));
        for (std::size_t i = 0; i < n; ++i) {
          if (cloud.face[i] > 1) labels[i] = -1;
        }
        worst = std::min(worst, purity(labels, cloud.face));
      }
      std::printf(
          "plate of %.1f spacings, %zu points, sigma %.1f h: worst purity of the sides %.4f, cover "
          "%.4f\n",
          thickness, n, sigma, worst, covered);
    }
  }
}

/// What is to be known of a segment's mesh.
struct MeshCheck {
  std::size_t accounted = 0;  ///< points in a triangle or reported
  std::size_t broken = 0;     ///< edges used twice in one direction, points on two boundaries
  std::size_t outer = 0;      ///< boundary curves
  std::size_t holes = 0;
  std::size_t small_holes = 0;  ///< of at most kHoleEdges points: gaps of the sampling
};

/// A hole that a random sample of a full face may not have.
constexpr std::size_t kHoleEdges = 8;

MeshCheck check(const SegmentMesh& mesh) {
  MeshCheck result;
  std::set<pcl::index_t> used(mesh.duplicates.begin(), mesh.duplicates.end());
  used.insert(mesh.loose.begin(), mesh.loose.end());
  std::set<std::pair<pcl::index_t, pcl::index_t>> directed;
  for (const auto& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      used.insert(t[c]);
      result.broken += directed.insert({t[c], t[(c + 1) % 3]}).second ? 0U : 1U;
    }
  }
  const std::set<pcl::index_t> boundary(mesh.boundary.begin(), mesh.boundary.end());
  result.broken += mesh.boundary.size() - boundary.size();
  result.accounted = used.size();
  for (std::size_t i = 0; i < mesh.loopCount(); ++i) {
    ++(mesh.is_hole[i] != 0 ? result.holes : result.outer);
    if (mesh.is_hole[i] != 0 && mesh.loops[i + 1] - mesh.loops[i] <= kHoleEdges)
      ++result.small_holes;
  }
  return result;
}

// The whole chain: normals, segments, meshes. The side of a hole is two boundary curves.
void surface(const std::vector<std::size_t>& sizes) {
  for (const std::size_t n : sizes) {
    for (const auto& [name, faces] : solids()) {
      double worst = 0;
      double seams = 0;
      MeshCheck sum;
      std::size_t missing = 0;
      for (unsigned seed = 1; seed <= 3; ++seed) {
        const LabelledCloud cloud = sample(name, faces, n, seed);
        const std::vector<float> normals = planeNormals(cloud.xyz, search(cloud.xyz, 12), 12);
        const CloudSegmentation ours = segment(cloud.xyz, normals, 12);
        const Segmentation& s = ours.segmentation();
        TriangulationOptions options;
        options.threads = 1;
        double area = 0;
        const std::vector<SegmentMesh> meshes =
            triangulateSegments(viewOf(cloud.xyz), s, options, false);
        for (std::size_t i = 0; i < meshes.size(); ++i) {
          if (s.segments[i].kind != SegmentKind::REGULAR) continue;
          const MeshCheck one = check(meshes[i]);
          sum.broken += one.broken;
          sum.holes += one.holes;
          sum.small_holes += one.small_holes;
          missing += s.segments[i].size - one.accounted;
          area += meshes[i].area;
        }
        worst = std::max(worst, std::abs(area / cloud.area - 1));
        seams += static_cast<double>(s.segments.size() - ours.faces().segments.size()) / 3;
      }
      std::printf(
          "%-16s %zu points: area off by at most %.3f, %.1f seams, points missing %zu, not "
          "manifold "
          "or turned %zu, holes %zu, small ones %zu\n",
          name.c_str(), n, worst, seams, missing, sum.broken, sum.holes, sum.small_holes);
      std::fflush(stdout);
    }
  }
}

void growth() {
  for (const std::size_t n : {100000U, 300000U, 1000000U}) {
    const LabelledCloud cloud =
        sample("square", {parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, n, 3);
    std::vector<pcl::index_t> members(n);
    std::iota(members.begin(), members.end(), 0);
    const std::size_t base = live_bytes;
    peak_bytes = base;
    const double start = cpuSeconds();
    const SegmentMesh mesh =
        triangulatePoints(viewOf(cloud.xyz), members.data(), n, {0.F, 0.F, 1.F}, {});
    const double seconds = cpuSeconds() - start;
    const double work = static_cast<double>(n) * std::log(static_cast<double>(n));
    std::printf("%8zu points: %.3f s = %.2f ns times n log n, %.0f bytes a point, area %.4f of 1\n",
                n, seconds, 1e9 * seconds / work,
                static_cast<double>(peak_bytes - base) / static_cast<double>(n), mesh.area);
  }
}

/// Over all files.
struct FileSums {
  std::size_t files = 0;
  std::size_t missing = 0;
  std::size_t broken = 0;
};

void file(const std::string& name, FileSums& sums) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  const bool ply = name.size() > 4 && name.substr(name.size() - 4) == ".ply";
  if ((ply ? pcl::io::loadPLYFile(name, cloud) : pcl::io::loadPCDFile(name, cloud)) < 0) return;
  const CloudPoints<pcl::PointXYZ> points(cloud);
  const CompactCloud compact = compactCloud(points.view());
  const std::vector<float> xyz(compact.xyz.begin(), compact.xyz.end());
  const std::vector<float> normals = planeNormals(xyz, search(xyz, 12), 12);
  const CloudSegmentation result = segment(xyz, normals, 12);
  const Segmentation& s = result.segmentation();
  const auto regular = regularLabels(s);
  const auto covered = std::count_if(regular.begin(), regular.end(), [](int l) { return l >= 0; });
  const SegmentationReport& report = result.report();
  TriangulationOptions options;
  options.threads = 1;
  const double start = cpuSeconds();
  const std::vector<SegmentMesh> meshes = triangulateSegments(compact.view(), s, options);
  const double seconds = cpuSeconds() - start;
  MeshCheck sum;
  std::size_t meshed = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (s.segments[i].kind != SegmentKind::REGULAR) continue;
    const MeshCheck one = check(meshes[i]);
    sum.accounted += one.accounted;
    sum.broken += one.broken;
    sum.outer += one.outer;
    sum.holes += one.holes;
    sum.small_holes += one.small_holes;
    meshed += s.segments[i].size;
  }
  std::printf(
      "%-32s regular %zu connected %zu isolated %zu faces %zu, cover %.4f | accounted for %zu of "
      "%zu, not manifold or turned %zu, outer boundaries %zu, holes %zu (small %zu), %.1f us a "
      "point\n",
      name.substr(name.rfind('/') + 1).c_str(), report.regular, report.connected, report.isolated,
      result.faces().segments.size(),
      static_cast<double>(covered) / static_cast<double>(regular.size()), sum.accounted, meshed,
      sum.broken, sum.outer, sum.holes, sum.small_holes,
      1e6 * seconds / static_cast<double>(meshed));
  std::fflush(stdout);
  ++sums.files;
  sums.missing += meshed - sum.accounted;
  sums.broken += sum.broken;
}

}  // namespace

int main(int argc, char** argv) {
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR);
  const std::string what = argc > 1 ? argv[1] : "quality";
  const std::size_t n = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 0;
  if (what == "quality") {
    quality(n > 0 ? n : 20000);
  } else if (what == "speed") {
    speed(n > 0 ? n : 1000000);
  } else if (what == "stability") {
    stability(n > 0 ? n : 20000);
  } else if (what == "plate") {
    plates(n > 0 ? n : 12000);
  } else if (what == "surface") {
    std::vector<std::size_t> sizes;
    for (int i = 2; i < argc; ++i) sizes.push_back(std::strtoull(argv[i], nullptr, 10));
    surface(sizes.empty() ? std::vector<std::size_t>{5000, 20000, 200000} : sizes);
  } else if (what == "growth") {
    growth();
  } else {
    FileSums sums;
    for (int i = 1; i < argc; ++i) file(argv[i], sums);
    std::printf("%zu files: points missing %zu, not manifold or turned %zu\n", sums.files,
                sums.missing, sums.broken);
  }
  return 0;
}
