// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Accuracy and time of all normal estimators, with and without recomputation, beside PCL's and, in
// accuracy, CGAL's where it is installed.
//   normals_benchmark [FILE...]    PCD or PLY files with true normals; without any, a torus and a
//   cube normals_benchmark --time [N]   one thread, ratios to our own all-points search; 1,000,000
//   points
#include <pcl/features/normal_3d_omp.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/mls.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "common/compact_cloud.h"
#include "features/automatic_normals.h"
#include "features/local_normals.h"
#include "features/recompute_normals.h"
#include "normals_peers.h"
#include "segmentation/region_growing.h"

namespace {

using namespace segorient;

struct Truth {
  std::vector<float> xyz;      // 4 floats a point
  std::vector<float> normals;  // 4 floats a point
  std::size_t size() const { return xyz.size() / 4; }
  PointView view() const { return {xyz.data(), 4, size()}; }
  void add(const float* p, const float* n) {
    xyz.insert(xyz.end(), {p[0], p[1], p[2], 0.F});
    normals.insert(normals.end(), {n[0], n[1], n[2], 0.F});
  }
};

Truth torus(std::size_t count, float noise) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(0.F, 1.F);
  std::normal_distribution<float> gauss(0.F, 1.F);
  const auto turn = static_cast<float>(2 * M_PI);
  Truth truth;
  while (truth.size() < count) {
    const float u = turn * uniform(generator);
    const float v = turn * uniform(generator);
    if (uniform(generator) * 1.4F > 1.F + 0.4F * std::cos(v)) continue;
    const float n[3] = {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)};
    const float p[3] = {std::cos(u) + 0.4F * n[0] + noise * gauss(generator),
                        std::sin(u) + 0.4F * n[1] + noise * gauss(generator),
                        0.4F * n[2] + noise * gauss(generator)};
    truth.add(p, n);
  }
  return truth;
}

Truth cube(std::size_t count, float noise) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<float> uniform(-1.F, 1.F);
  std::normal_distribution<float> gauss(0.F, noise);
  Truth truth;
  for (std::size_t i = 0; i < count; ++i) {
    float p[3] = {uniform(generator), uniform(generator), uniform(generator)};
    float n[3] = {0.F, 0.F, 0.F};
    n[i % 3] = p[i % 3] = i % 6 < 3 ? 1.F : -1.F;
    for (int a = 0; noise > 0.F && a < 3; ++a) p[a] += gauss(generator);
    truth.add(p, n);
  }
  return truth;
}

bool load(const std::string& file, Truth& truth) {
  pcl::PointCloud<pcl::PointNormal> cloud;
  const bool ply = file.size() > 4 && file.substr(file.size() - 4) == ".ply";
  if ((ply ? pcl::io::loadPLYFile(file, cloud) : pcl::io::loadPCDFile(file, cloud)) < 0)
    return false;
  for (const auto& p : cloud) truth.add(p.data, p.normal);
  return true;
}

/// Distinct points in canonical order, as the pipeline works on them.
Truth compacted(const Truth& truth) {
  const CompactCloud cloud = compactCloud(truth.view());
  Truth result;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    result.add(&cloud.xyz[4 * i], &truth.normals[4 * static_cast<std::size_t>(cloud.source[i])]);
  }
  return result;
}

void build(const PointView& points, int threads, search::MedianHashIndex& index) {
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index.build(points, nullptr, options);
}

Neighborhoods neighbors(const PointView& points, int k, int threads) {
  search::MedianHashIndex index;
  build(points, threads, index);
  Neighborhoods table;
  index.nearestKAll(k + 1, table);
  return table;
}

double degrees(const float* a, const float* b) {
  const double x[3] = {a[0], a[1], a[2]};
  const double y[3] = {b[0], b[1], b[2]};
  const double c =
      std::hypot(x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]);
  return std::atan2(c, std::abs(x[0] * y[0] + x[1] * y[1] + x[2] * y[2])) * 180 / M_PI;
}

/// A point is near an edge if one of its ten nearest has a true normal 30 degrees away.
std::vector<char> edges(const Truth& truth, const Neighborhoods& table) {
  std::vector<char> near(truth.size(), 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (int j = 1; j < std::min(11, table.count(i)); ++j) {
      const auto q = static_cast<std::size_t>(table.indices(i)[j]);
      if (degrees(&truth.normals[4 * i], &truth.normals[4 * q]) > 30) near[i] = 1;
    }
  }
  return near;
}

void printErrors(std::vector<double> angles) {
  if (angles.empty()) {
    std::printf(" %38s", "-");
    return;
  }
  std::sort(angles.begin(), angles.end());
  double squares = 0;
  for (const double a : angles) squares += a * a;
  const auto within = [&](double limit) {
    return 100.0 *
           static_cast<double>(std::lower_bound(angles.begin(), angles.end(), limit) -
                               angles.begin()) /
           static_cast<double>(angles.size());
  };
  std::printf(" %6.2f %6.2f %6.2f %5.1f%% %5.1f%%",
              std::sqrt(squares / static_cast<double>(angles.size())), angles[angles.size() / 2],
              angles[angles.size() * 9 / 10], within(5), within(10));
}

void printRow(const char* name, const Truth& truth, const std::vector<char>& near,
              const std::vector<float>& normals) {
  std::vector<double> groups[2];
  std::size_t undefined = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double angle = degrees(&truth.normals[4 * i], &normals[4 * i]);
    if (std::isnan(angle)) {
      ++undefined;
    } else {
      groups[near[i] ? 1 : 0].push_back(angle);
    }
  }
  std::printf("  %-22s", name);
  printErrors(groups[0]);
  std::printf("  |");
  printErrors(groups[1]);
  if (undefined > 0) std::printf("  (%zu undefined)", undefined);
  std::printf("\n");
}

std::vector<float> estimated(const Truth& truth, const Neighborhoods& table,
                             NormalEstimator estimator, int k) {
  LocalNormalOptions options;
  options.estimator = estimator;
  options.k = k;
  std::vector<float> normals(4 * truth.size());
  estimateNormals(truth.view(), table, options, normals.data());
  return normals;
}

std::vector<std::uint8_t> regularOf(const Segmentation& segmentation) {
  std::vector<std::uint8_t> regular;
  for (const Segment& s : segmentation.segments) {
    regular.push_back(s.kind == SegmentKind::REGULAR);
  }
  return regular;
}

std::vector<float> recomputed(const Truth& truth, const Neighborhoods& table,
                              std::vector<float> normals, RecomputationRule rule) {
  SegmentationOptions segmentation;
  segmentation.neighbors = 12;
  RecomputationOptions options;
  options.rule = rule;
  options.k = 20;
  for (int round = 0; round < 2; ++round) {
    const Segmentation segments =
        segmentByNormals(truth.view(), {normals.data(), 4, truth.size()}, table, segmentation);
    std::vector<std::int32_t> labels = segments.labels;
    recomputeNormals(truth.view(), table, regularOf(segments), options, labels, normals);
  }
  return normals;
}

pcl::PointCloud<pcl::PointXYZ>::Ptr pclCloud(const Truth& truth) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    cloud->push_back({truth.xyz[4 * i], truth.xyz[4 * i + 1], truth.xyz[4 * i + 2]});
  }
  return cloud;
}

std::vector<float> pclNormals(const Truth& truth, int k) {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(pclCloud(truth));
  estimation.setKSearch(k);
  pcl::PointCloud<pcl::Normal> out;
  estimation.compute(out);
  std::vector<float> normals(4 * truth.size());
  for (std::size_t i = 0; i < out.size(); ++i) std::copy_n(out[i].normal, 3, &normals[4 * i]);
  return normals;
}

std::vector<float> pclMovingLeastSquares(const Truth& truth, double radius) {
  pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointNormal> mls;
  mls.setInputCloud(pclCloud(truth));
  mls.setComputeNormals(true);
  mls.setPolynomialOrder(2);
  mls.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  mls.setSearchRadius(radius);
  pcl::PointCloud<pcl::PointNormal> out;
  mls.process(out);
  std::vector<float> normals(4 * truth.size(), std::nanf(""));
  const auto source = mls.getCorrespondingIndices();
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::copy_n(out[i].normal, 3, &normals[4 * static_cast<std::size_t>(source->indices[i])]);
  }
  return normals;
}

void accuracy(const std::string& name, const Truth& raw) {
  const Truth truth = compacted(raw);
  const Neighborhoods table = neighbors(truth.view(), kMostAutomaticNeighbors, 0);
  const std::vector<char> near = edges(truth, table);
  std::printf("%s: %zu points, %zu near edges\n  %-22s %38s  | %38s\n", name.c_str(), truth.size(),
              static_cast<std::size_t>(std::count(near.begin(), near.end(), 1)), "",
              "smooth: rms median p90 <5 <10 deg", "near edges: the same");
  const struct {
    const char* name;
    NormalEstimator estimator;
    int k;
  } estimators[] = {{"plane k=10", NormalEstimator::PLANE, 10},
                    {"plane k=30", NormalEstimator::PLANE, 30},
                    {"LCT k=10", NormalEstimator::LCT, 10},
                    {"LDT k=10", NormalEstimator::LDT, 10},
                    {"AwAS quadratic k=10", NormalEstimator::AWAS_QUADRATIC, 10},
                    {"AwAS quadratic k=30", NormalEstimator::AWAS_QUADRATIC, 30},
                    {"AwAS cubic k=10", NormalEstimator::AWAS_CUBIC, 10},
                    {"AwAS cubic k=30", NormalEstimator::AWAS_CUBIC, 30}};
  for (const auto& e : estimators) {
    printRow(e.name, truth, near, estimated(truth, table, e.estimator, e.k));
  }
  std::vector<float> normals(4 * truth.size());
  const AutomaticNormalReport report =
      estimateNormalsAutomatically(truth.view(), table, 0, normals.data());
  printRow("automatic", truth, near, normals);
  const std::vector<float> planes = estimated(truth, table, NormalEstimator::PLANE, 10);
  printRow("plane, one-sided", truth, near,
           recomputed(truth, table, planes, RecomputationRule::ONE_SIDED));
  printRow("plane, paper's rule", truth, near,
           recomputed(truth, table, planes, RecomputationRule::MODIFIED_NEIGHBORHOODS));
  printRow("automatic, one-sided", truth, near,
           recomputed(truth, table, normals, RecomputationRule::ONE_SIDED));
  printRow("PCL plane k=11", truth, near, pclNormals(truth, 11));
  printRow("PCL plane k=30", truth, near, pclNormals(truth, 30));
  // The radius that holds thirty neighbours on average.
  double radius = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int last = std::min(30, table.count(i) - 1);
    radius += std::sqrt(static_cast<double>(table.sqrDistances(i)[last]));
  }
  printRow("PCL MLS", truth, near,
           pclMovingLeastSquares(truth, radius / static_cast<double>(truth.size())));
  for (const unsigned k : {11U, 30U}) {
    const std::vector<float> jet = benchmark::cgalJetNormals(truth.view(), k);
    const std::string row = "CGAL jet k=" + std::to_string(k);
    if (!jet.empty()) printRow(row.c_str(), truth, near, jet);
  }
  std::printf("  chosen: %s\n", report.text().c_str());
}

/// One round of recomputation, again and again from the same labels and normals.
class Recomputation {
 public:
  Recomputation(const Truth& truth, int k) : truth_(truth), k_(k) {
    build(truth.view(), 1, index_);
    search();
    first_normals_ = estimated(truth, table_, NormalEstimator::PLANE, 10);
    const Segmentation segments = segmentByNormals(
        truth.view(), {first_normals_.data(), 4, truth.size()}, table_, SegmentationOptions());
    regular_ = regularOf(segments);
    first_labels_ = segments.labels;
  }
  void search() { index_.nearestKAll(k_ + 1, table_); }
  void start() {
    labels_ = first_labels_;
    normals_ = first_normals_;
  }
  void run() {
    RecomputationOptions options;
    options.threads = 1;
    recomputeNormals(truth_.view(), table_, regular_, options, labels_, normals_);
  }

 private:
  const Truth& truth_;
  int k_;
  search::MedianHashIndex index_;
  Neighborhoods table_;
  std::vector<std::uint8_t> regular_;
  std::vector<std::int32_t> first_labels_, labels_;
  std::vector<float> first_normals_, normals_;
};

/// Medians of five rounds in turn.
void timing(std::size_t count) {
  const Truth truth = compacted(torus(count, 0.F));
  const Truth sharp = compacted(cube(count, 0.F));
  constexpr int kNeighbors = 10;
  const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud = pclCloud(truth);
  search::MedianHashIndex index;
  build(truth.view(), 1, index);
  Neighborhoods table;
  index.nearestKAll(kNeighbors + 1, table);
  std::vector<float> normals(4 * truth.size());
  const auto estimate = [&](NormalEstimator estimator) {
    LocalNormalOptions local;
    local.estimator = estimator;
    local.threads = 1;
    estimateNormals(truth.view(), table, local, normals.data());
  };
  // PCL's step from ready neighbours, as NormalEstimationOMP takes it.
  const auto pclStep = [&] {
    pcl::Indices row(kNeighbors + 1);
    Eigen::Vector4f plane;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      std::copy_n(table.indices(i), kNeighbors + 1, row.data());
      float curvature = 0;
      pcl::computePointNormal(*cloud, row, plane, curvature);
      pcl::flipNormalTowardsViewpoint((*cloud)[i], 0.F, 0.F, 0.F, plane);
      std::copy_n(plane.data(), 3, &normals[4 * i]);
      normals[4 * i + 3] = curvature;
    }
  };
  // Sharp edges, with as many neighbours as for the estimators, and with twice as many.
  Recomputation few(sharp, kNeighbors);
  Recomputation many(sharp, 20);
  const struct {
    const char* name;
    std::function<void()> run;
  } steps[] = {{"own search, k = 10", [&] { index.nearestKAll(kNeighbors + 1, table); }},
               {"plane", [&] { estimate(NormalEstimator::PLANE); }},
               {"LCT", [&] { estimate(NormalEstimator::LCT); }},
               {"LDT", [&] { estimate(NormalEstimator::LDT); }},
               {"AwAS quadratic", [&] { estimate(NormalEstimator::AWAS_QUADRATIC); }},
               {"AwAS cubic", [&] { estimate(NormalEstimator::AWAS_CUBIC); }},
               {"PCL's plane step", pclStep},
               {"own search, cube", [&] { few.search(); }},
               {"recomputation, one round", [&] { few.run(); }},
               {"own search, cube, k = 20", [&] { many.search(); }},
               {"recomputation, k = 20", [&] { many.run(); }}};
  std::vector<std::vector<double>> seconds(std::size(steps));
  for (int round = 0; round < 5; ++round) {
    few.start();
    many.start();
    for (std::size_t s = 0; s < std::size(steps); ++s) {
      const auto start = std::chrono::steady_clock::now();
      steps[s].run();
      seconds[s].push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  }
  for (auto& s : seconds) std::sort(s.begin(), s.end());
  // Each step beside the search that made its table.
  std::size_t search_of = 0;
  std::size_t pcl = 0;
  while (std::string(steps[pcl].name) != "PCL's plane step") ++pcl;
  for (std::size_t s = 0; s < std::size(steps); ++s) {
    if (std::string(steps[s].name).rfind("own search", 0) == 0) search_of = s;
    std::printf("%-26s %7.1f ns a point  %5.2f of the search  %5.2f of PCL's step\n", steps[s].name,
                1e9 * seconds[s][2] / static_cast<double>(count),
                seconds[s][2] / seconds[search_of][2], seconds[s][2] / seconds[pcl][2]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--time") {
    timing(argc > 2 ? std::stoul(argv[2]) : 1000000);
    return 0;
  }
  for (int a = 1; a < argc; ++a) {
    Truth truth;
    if (load(argv[a], truth)) {
      accuracy(argv[a], truth);
    } else {
      std::fprintf(stderr, "%s: cannot be read\n", argv[a]);
    }
  }
  if (argc > 1) return 0;
  constexpr std::size_t kCount = 20000;
  // Noise in units of the mean distance between points.
  for (const float noise : {0.F, 0.1F, 0.25F, 0.5F}) {
    const std::string suffix = ", noise " + std::to_string(noise).substr(0, 4);
    accuracy("torus" + suffix, torus(kCount, noise * std::sqrt(15.79F / kCount)));
    accuracy("cube" + suffix, cube(kCount, noise * std::sqrt(24.F / kCount)));
  }
  return 0;
}
