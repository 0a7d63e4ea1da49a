// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// search::MedianHash against the searches that a PCL user has today, in one process and in turn.
// Prints times as multiples: how many times as fast as a loop of queries to pcl::search::KdTree.
//
//   search_benchmark [--points N] [--k K,K,...] [--cloud NAME] [--runs R] [--threads T] [--slow]
//
// NAME: uniform, uniform-curve, surface, surface-random, lidar, lidar-random. --slow adds PCL's
// octree and plain FLANN. SEGORIENT_SIMD=scalar|sse2|avx2 forces an instruction set.
#include <pcl/io/pcd_io.h>
#include <pcl/search/kdtree.h>
#include <pcl/search/octree.h>
#include <segorient/search/median_hash.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <sstream>

#include "benchmark_clouds.h"
#ifdef SEGORIENT_HAVE_NANOFLANN
#include <nanoflann.hpp>
#endif

namespace segorient::benchmark {
namespace {

struct Options {
  std::size_t points = 200000;
  std::vector<int> k{5, 10, 15, 25, 50};
  std::string cloud;
  int runs = 3;
  unsigned int threads = 1;
  bool slow = false;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--slow") {
      options.slow = true;
      continue;
    }
    if (i + 1 == argc) break;
    const char* value = argv[++i];
    if (name == "--points") options.points = std::strtoull(value, nullptr, 10);
    if (name == "--cloud") options.cloud = value;
    if (name == "--runs") options.runs = std::atoi(value);
    if (name == "--threads") options.threads = static_cast<unsigned int>(std::atoi(value));
    if (name == "--k") {
      options.k.clear();
      std::stringstream list(value);
      for (std::string k; std::getline(list, k, ',');) options.k.push_back(std::stoi(k));
    }
  }
  return options;
}

/// Contenders measured in turn, so that all of them meet the same load of the machine.
class Race {
 public:
  explicit Race(const Options& options) : wall_clock_(options.threads != 1) {}

  using Work = std::function<double()>;  ///< does the work, returns a sum over its results
  void add(const std::string& name, Work work) {
    contenders_.push_back({name, std::move(work), {}});
  }

  /// Prints medians relative to the first contender, and its time for one of `items`.
  void run(const std::string& title, int runs, std::size_t items) {
    for (int r = 0; r < runs; ++r) {
      for (auto& c : contenders_) {
        const double start = now();
        sink_ += c.work();
        c.seconds.push_back(now() - start);
      }
    }
    std::printf("%-44s", title.c_str());
    const double base = median(contenders_.front().seconds);
    for (auto& c : contenders_) {
      const double seconds = median(c.seconds);
      if (&c == &contenders_.front()) {
        std::printf(" %s %.0f ns |", c.name.c_str(), 1e9 * seconds / static_cast<double>(items));
      } else {
        std::printf(" %s %.2f |", c.name.c_str(), base / seconds);
      }
    }
    std::printf("\n");
    std::fflush(stdout);
  }

 private:
  // Processor time where one thread works, so that other programs matter less.
  double now() const {
    if (wall_clock_) {
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
          .count();
    }
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }
  static double median(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }
  struct Contender {
    std::string name;
    Work work;
    std::vector<double> seconds;
  };
  std::vector<Contender> contenders_;
  bool wall_clock_;
  double sink_ = 0.0;
};

#ifdef SEGORIENT_HAVE_NANOFLANN
/// nanoflann on a PCL cloud, in place.
class Nanoflann {
 public:
  explicit Nanoflann(const Cloud& cloud) : adaptor_{cloud}, tree_(3, adaptor_, {15}) {
    tree_.buildIndex();
  }
  std::size_t nearestK(const float* query, std::size_t k, std::uint32_t* indices,
                       float* distances) const {
    return tree_.knnSearch(query, k, indices, distances);
  }

 private:
  struct Adaptor {
    const Cloud& cloud;
    std::size_t kdtree_get_point_count() const { return cloud.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return cloud[i].data[axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;
    }
  };
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3>;
  Adaptor adaptor_;
  Tree tree_;
};
#endif

double queryLoop(const pcl::search::Search<pcl::PointXYZ>& tree, const Cloud& queries, int k) {
  pcl::Indices indices;
  std::vector<float> distances;
  double sum = 0.0;
  for (const auto& q : queries) {
    tree.nearestKSearch(q, k, indices, distances);
    sum += static_cast<double>(distances.back());
  }
  return sum;
}

double radiusLoop(const pcl::search::Search<pcl::PointXYZ>& tree, const Cloud& queries, double r) {
  pcl::Indices indices;
  std::vector<float> distances;
  double sum = 0.0;
  for (const auto& q : queries) {
    tree.radiusSearch(q, r, indices, distances);
    sum += static_cast<double>(distances.size());
  }
  return sum;
}

double allPoints(const search::MedianHash<pcl::PointXYZ>& tree, int k, bool with_distances,
                 Neighborhoods& table) {
  tree.nearestKSearchAll(k, table, with_distances);
  return static_cast<double>(table.indices(table.size() / 2)[table.count(0) - 1]);
}

/// Mean distance to the 20th neighbour: a radius of about 20 results.
double radiusOf20(const pcl::search::Search<pcl::PointXYZ>& tree, const Cloud& cloud) {
  pcl::Indices indices;
  std::vector<float> distances;
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 1 + cloud.size() / 1000, ++count) {
    tree.nearestKSearch(cloud[i], 20, indices, distances);
    sum += std::sqrt(static_cast<double>(distances.back()));
  }
  return sum / count;
}

/// Each coordinate moved by about a spacing: queries that are not points of the cloud.
Cloud::Ptr moved(const Cloud& cloud, double radius) {
  auto copy = pcl::make_shared<Cloud>(cloud);
  std::mt19937 random(5);
  std::normal_distribution<float> g(0.0F, static_cast<float>(radius) / 4.0F);
  for (auto& p : *copy) p.getVector3fMap() += Eigen::Vector3f(g(random), g(random), g(random));
  return copy;
}

void measure(const std::string& name, const Cloud::Ptr& cloud, const Options& options) {
  std::printf("\n%s, %zu points\n", name.c_str(), cloud->size());
  pcl::search::KdTree<pcl::PointXYZ> pcl_tree;
  pcl_tree.setInputCloud(cloud);
  search::MedianHash<pcl::PointXYZ> ours;
  ours.setNumberOfThreads(options.threads);
  ours.setInputCloud(cloud);
  std::printf("memory of the structure: %.1f bytes a point\n",
              static_cast<double>(ours.memory()) / static_cast<double>(cloud->size()));
  {
    Race race(options);
    race.add("pcl", [&] {
      pcl::search::KdTree<pcl::PointXYZ> tree;
      tree.setInputCloud(cloud);
      return 0.0;
    });
    race.add("median hash", [&] {
      search::MedianHash<pcl::PointXYZ> tree;
      tree.setNumberOfThreads(options.threads);
      tree.setInputCloud(cloud);
      return 0.0;
    });
#ifdef SEGORIENT_HAVE_NANOFLANN
    race.add("nanoflann", [&] {
      const Nanoflann tree(*cloud);
      return 0.0;
    });
#endif
    race.run("build", options.runs, cloud->size());
  }
#ifdef SEGORIENT_HAVE_NANOFLANN
  const Nanoflann nano(*cloud);
#endif
  pcl::search::Octree<pcl::PointXYZ> octree(radiusOf20(ours, *cloud));
  if (options.slow) octree.setInputCloud(cloud);
  const auto separate = moved(*shuffled(*cloud, 3), radiusOf20(ours, *cloud));
  Neighborhoods table;
  for (const int k : options.k) {
    Race race(options);
    race.add("pcl", [&] { return queryLoop(pcl_tree, *cloud, k); });
    race.add("all points", [&] { return allPoints(ours, k, true, table); });
    race.add("without distances", [&] { return allPoints(ours, k, false, table); });
    race.add("query by query", [&] { return queryLoop(ours, *cloud, k); });
#ifdef SEGORIENT_HAVE_NANOFLANN
    race.add("nanoflann", [&] {
      std::vector<std::uint32_t> indices(static_cast<std::size_t>(k));
      std::vector<float> distances(static_cast<std::size_t>(k));
      double sum = 0.0;
      for (const auto& q : *cloud) {
        nano.nearestK(q.data, indices.size(), indices.data(), distances.data());
        sum += static_cast<double>(distances.back());
      }
      return sum;
    });
#endif
    if (options.slow) {
      race.add("pcl octree", [&] { return queryLoop(octree, *cloud, k); });
    }
    race.run("k = " + std::to_string(k), options.runs, cloud->size());
  }
  {
    const int k = 15;
    Race race(options);
    race.add("pcl", [&] { return queryLoop(pcl_tree, *separate, k); });
    race.add("query by query", [&] { return queryLoop(ours, *separate, k); });
    race.run("separate queries, k = 15", options.runs, cloud->size());
  }
  {
    const double radius = radiusOf20(ours, *cloud);
    Race race(options);
    race.add("pcl", [&] { return radiusLoop(pcl_tree, *cloud, radius); });
    race.add("query by query", [&] { return radiusLoop(ours, *cloud, radius); });
    race.run("radius, about 20 results", options.runs, cloud->size());
  }
  {
    Race race(options);
    race.add("exact", [&] { return queryLoop(ours, *cloud, 15); });
    for (const float epsilon : {0.1F, 0.5F, 1.0F}) {
      race.add("epsilon " + std::to_string(epsilon).substr(0, 3), [&, epsilon] {
        ours.setEpsilon(epsilon);
        const double sum = queryLoop(ours, *cloud, 15);
        ours.setEpsilon(0.0F);
        return sum;
      });
    }
    race.add("all points, epsilon 1", [&] {
      ours.setEpsilon(1.0F);
      const double sum = allPoints(ours, 15, true, table);
      ours.setEpsilon(0.0F);
      return sum;
    });
    race.run("approximate, k = 15", options.runs, cloud->size());
  }
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  const std::size_t n = options.points;
  const std::map<std::string, std::function<Cloud::Ptr()>> clouds{
      {"uniform", [&] { return uniformCube(n, 1); }},
      {"uniform-curve", [&] { return alongCurve(*uniformCube(n, 1)); }},
      {"surface", [&] { return alongCurve(*bumpySphere(n, 1)); }},
      {"surface-random", [&] { return bumpySphere(n, 1); }},
      {"lidar", [&] { return lidarLike(n, 1); }},
      {"lidar-random", [&] { return shuffled(*lidarLike(n, 1), 2); }}};
  for (const auto& [name, make] : clouds) {
    if (options.cloud.empty() || options.cloud == name) measure(name, make(), options);
  }
  return 0;
}

}  // namespace
}  // namespace segorient::benchmark

int main(int argc, char** argv) {
  return segorient::benchmark::run(argc, argv);
}
