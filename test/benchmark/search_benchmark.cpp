// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// search::MedianHash against the searches that a PCL user has today, in one process and in turn.
// Prints times as multiples: how many times as fast as the first of a line, which is
// pcl::search::KdTree with a loop of queries.
//
//   search_benchmark [--points N,...] [--k K,...] [--cloud NAME,...] [--order NAME,...] [--runs R]
//                    [--threads T,...] [--csv FILE] [--whole] [--growth]
//
// NAME of a cloud: uniform, surface, lidar; of an order: coherent (along a curve or as scanned),
// random. --threads 0 means all cores. --whole measures all of them with 20k to 5M points; without
// it, 200k points on one thread. --growth measures MedianHash alone, in random order: time a point
// of 5M against 200k, and two threads against one. SEGORIENT_SIMD=scalar|sse2|avx2|avx512 forces an
// instruction set.
#include <pcl/search/kdtree.h>
#include <pcl/search/octree.h>
#include <segorient/search/median_hash.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "search_growth.h"
#include "search_peers.h"

namespace segorient::benchmark {
namespace {

using OurTree = search::MedianHash<pcl::PointXYZ>;
using PclTree = pcl::search::KdTree<pcl::PointXYZ>;

struct Options {
  std::vector<std::size_t> points{200000};
  std::vector<std::size_t> k{5, 15, 50};
  std::vector<std::size_t> threads{1};
  std::vector<std::string> clouds{"uniform", "surface", "lidar"};
  std::vector<std::string> orders{"coherent", "random"};
  std::size_t runs = 3;
  std::string csv;
  bool growth = false;
};

std::vector<std::string> words(const std::string& list) {
  std::vector<std::string> result;
  std::stringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) result.push_back(word);
  return result;
}

std::vector<std::size_t> numbers(const std::string& list) {
  std::vector<std::size_t> result;
  for (const auto& word : words(list)) result.push_back(std::strtoull(word.c_str(), nullptr, 10));
  return result;
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--whole") {
      options.points = {20000, 200000, 1000000, 5000000};
      options.k = {5, 10, 15, 25, 50};
      options.threads = {1, 0};
      continue;
    }
    if (name == "--growth") {
      options.growth = true;
      continue;
    }
    if (i + 1 == argc) break;
    const char* value = argv[++i];
    if (name == "--points") options.points = numbers(value);
    if (name == "--k") options.k = numbers(value);
    if (name == "--threads") options.threads = numbers(value);
    if (name == "--cloud") options.clouds = words(value);
    if (name == "--order") options.orders = words(value);
    if (name == "--runs") options.runs = numbers(value).front();
    if (name == "--csv") options.csv = value;
  }
  return options;
}

Cloud::Ptr makeCloud(const std::string& name, const std::string& order, std::size_t n) {
  const bool coherent = order == "coherent";
  if (name == "lidar") return coherent ? lidarLike(n, 1) : shuffled(*lidarLike(n, 1), 2);
  const Cloud::Ptr random = name == "surface" ? bumpySphere(n, 1) : uniformCube(n, 1);
  return coherent ? alongCurve(*random) : random;
}

/// A radius of 20 results on average, by bisection over a sample.
double radiusOf20(const OurTree& tree, const Cloud& cloud) {
  pcl::Indices indices;
  std::vector<float> distances;
  double low = 0.0;
  tree.nearestKSearch(cloud[cloud.size() / 2], 20, indices, distances);
  double high = 16.0 * std::sqrt(static_cast<double>(distances.back()));
  for (int step = 0; step < 20; ++step) {
    const double radius = 0.5 * (low + high);
    std::size_t results = 0;
    std::size_t asked = 0;
    for (std::size_t i = 0; i < cloud.size(); i += 1 + cloud.size() / 1000, ++asked) {
      results += static_cast<std::size_t>(tree.radiusSearch(cloud[i], radius, indices, distances));
    }
    (results < 20 * asked ? low : high) = radius;
  }
  return high;
}

/// Each coordinate moved by about a spacing, in random order: queries that are not of the cloud.
Cloud::Ptr separateQueries(const Cloud& cloud, double radius) {
  auto queries = shuffled(cloud, 3);
  std::mt19937 random(5);
  std::normal_distribution<float> g(0.0F, static_cast<float>(radius) / 4.0F);
  for (auto& p : *queries) p.getVector3fMap() += Eigen::Vector3f(g(random), g(random), g(random));
  return queries;
}

/// All races on one cloud.
class CloudRaces {
 public:
  CloudRaces(const std::string& name, const std::string& order, std::size_t points,
             unsigned int threads, std::size_t runs, std::vector<Measurement>& results)
      : cloud_(makeCloud(name, order, points)),
        like_{name, order, points, threads, "", "", 0, 0.0, 0.0},
        runs_(static_cast<int>(runs)),
        results_(results) {
    pcl_.setInputCloud(cloud_);
    ours_.setNumberOfThreads(threads);
    ours_.setInputCloud(cloud_);
    radius_ = radiusOf20(ours_, *cloud_);
    std::printf("%s, %s order, %zu points, threads %u: %.1f bytes a point\n", name.c_str(),
                order.c_str(), points, threads,
                static_cast<double>(ours_.memory()) / static_cast<double>(points));
  }

  void run(const std::vector<std::size_t>& ks) {
    build();
    const Flann flann(*cloud_);
#ifdef SEGORIENT_HAVE_NANOFLANN
    const Nanoflann nano(*cloud_);
#endif
    // The octree is left out where it would take longer than all others together.
    const bool with_octree = cloud_->size() <= 200000;
    pcl::search::Octree<pcl::PointXYZ> octree(radius_);
    if (with_octree) octree.setInputCloud(cloud_);
    const unsigned int threads = like_.threads;
    for (const std::size_t wanted : ks) {
      const int k = static_cast<int>(wanted);
      Race race;
      race.add("pcl kdtree", [&, k] { nearestLoop(pcl_, *cloud_, k, threads); });
      race.add("all points", [&, k] { ours_.nearestKSearchAll(k, table_); });
      race.add("without distances", [&, k] { ours_.nearestKSearchAll(k, table_, false); });
      race.add("query by query", [&, k] { nearestLoop(ours_, *cloud_, k, threads); });
#ifdef SEGORIENT_HAVE_NANOFLANN
      race.add("nanoflann", [&, k] { nano.nearest(*cloud_, k, threads); });
#endif
      race.add("flann", [&, k] { flann.nearest(*cloud_, k, threads); });
      if (with_octree && k == 15) {
        race.add("pcl octree", [&, k] { nearestLoop(octree, *cloud_, k, threads); });
      }
      finish(race, "nearest", k);
    }
    const Cloud::Ptr queries = separateQueries(*cloud_, radius_);
    Race separate;
    separate.add("pcl kdtree", [&] { nearestLoop(pcl_, *queries, 15, threads); });
    separate.add("query by query", [&] { nearestLoop(ours_, *queries, 15, threads); });
#ifdef SEGORIENT_HAVE_NANOFLANN
    separate.add("nanoflann", [&] { nano.nearest(*queries, 15, threads); });
#endif
    finish(separate, "separate queries", 15);
    Race within;
    RadiusNeighborhoods rows;
    within.add("pcl kdtree", [&] { radiusLoop(pcl_, *cloud_, radius_, threads); });
    within.add("all points", [&] { ours_.radiusSearchAll(radius_, rows); });
    within.add("query by query", [&] { radiusLoop(ours_, *cloud_, radius_, threads); });
#ifdef SEGORIENT_HAVE_NANOFLANN
    within.add("nanoflann", [&] { nano.within(*cloud_, radius_, threads); });
#endif
    finish(within, "radius of 20", 0);
    approximate();
  }

 private:
  void finish(Race& race, const std::string& task, int k) {
    like_.task = task;
    like_.k = k;
    race.run(runs_, like_, results_);
  }

  void build() {
    Race race;
    race.add("pcl kdtree", [&] { PclTree().setInputCloud(cloud_); });
    race.add("median hash", [&] {
      OurTree tree;
      tree.setNumberOfThreads(like_.threads);
      tree.setInputCloud(cloud_);
    });
#ifdef SEGORIENT_HAVE_NANOFLANN
    race.add("nanoflann", [&] { const Nanoflann tree(*cloud_); });
#endif
    finish(race, "build", 0);
  }

  // What approximation gains over the exact search of the same kind.
  void approximate() {
    const int k = 15;
    Race single;
    Race all;
    for (const float epsilon : {0.0F, 0.1F, 0.5F, 1.0F}) {
      const std::string name = "epsilon " + std::to_string(epsilon).substr(0, 3);
      single.add(name, [&, epsilon] {
        ours_.setEpsilon(epsilon);
        nearestLoop(ours_, *cloud_, k, like_.threads);
      });
      all.add(name, [&, epsilon] {
        ours_.setEpsilon(epsilon);
        ours_.nearestKSearchAll(k, table_);
      });
    }
    finish(single, "approximate", k);
    finish(all, "all approximate", k);
    ours_.setEpsilon(0.0F);
  }

  Cloud::Ptr cloud_;
  Measurement like_;
  int runs_;
  std::vector<Measurement>& results_;
  PclTree pcl_;
  OurTree ours_;
  Neighborhoods table_;
  double radius_ = 0.0;
};

void writeCsv(const std::string& file, const std::vector<Measurement>& results) {
  std::ofstream out(file);
  out << "cloud,order,points,threads,task,k,method,nanoseconds,times_as_fast\n";
  for (const Measurement& m : results) {
    out << m.cloud << ',' << m.order << ',' << m.points << ',' << m.threads << ',' << m.task << ','
        << m.k << ',' << m.method << ',' << m.nanoseconds << ',' << m.times_as_fast << '\n';
  }
}

void growth(const Options& options) {
  for (const std::string& name : options.clouds) {
    const Cloud::Ptr clouds[2] = {makeCloud(name, "random", 200000),
                                  makeCloud(name, "random", 5000000)};
    double radius[2];
    for (int i = 0; i < 2; ++i) {
      OurTree tree;
      tree.setInputCloud(clouds[i]);
      radius[i] = radiusOf20(tree, *clouds[i]);
    }
    Growth(name, clouds[0], clouds[1], options.runs).run(options.k, radius);
  }
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  if (options.growth) {
    growth(options);
    return 0;
  }
  std::vector<Measurement> results;
  for (const std::size_t points : options.points) {
    for (const std::string& cloud : options.clouds) {
      for (const std::string& order : options.orders) {
        for (const std::size_t threads : options.threads) {
          CloudRaces(cloud, order, points, static_cast<unsigned int>(threads), options.runs,
                     results)
              .run(options.k);
          if (!options.csv.empty()) writeCsv(options.csv, results);
        }
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace segorient::benchmark

int main(int argc, char** argv) {
  return segorient::benchmark::run(argc, argv);
}
