// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// One query at a time, k = 1 and 10, from the points to ten diagonals away: MedianHash beside
// pcl::search::KdTree. Ends with 1 if it is not 1.5 times as fast everywhere.
//
//   far_queries_benchmark [POINTS [K ...]]
#include <pcl/search/kdtree.h>
#include <segorient/search/median_hash.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>
#include <utility>

#include "benchmark_clouds.h"
#include "search_race.h"

namespace segorient::benchmark {
namespace {

constexpr double kLeastRatio = 1.5;

float diagonalOf(const Cloud& cloud) {
  Eigen::Vector3f lo = cloud.front().getVector3fMap();
  Eigen::Vector3f hi = lo;
  for (const auto& p : cloud) {
    lo = lo.cwiseMin(p.getVector3fMap());
    hi = hi.cwiseMax(p.getVector3fMap());
  }
  return (hi - lo).norm();
}

/// Points of the cloud, each moved by `away`: in the order of the cloud and in directions that turn
/// slowly, or in any order and in any direction.
Cloud queriesAway(const Cloud& cloud, std::size_t count, float away, bool in_order) {
  std::mt19937 random(11);
  std::normal_distribution<float> g(0.0F, 1.0F);
  std::uniform_int_distribution<std::size_t> any(0, cloud.size() - 1);
  Eigen::Vector3f direction(g(random), g(random), g(random));
  Cloud queries;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f turn(g(random), g(random), g(random));
    direction = in_order ? Eigen::Vector3f(direction.normalized() + 0.02F * turn) : turn;
    const std::size_t row = in_order ? (cloud.size() / 4 + i) % cloud.size() : any(random);
    const Eigen::Vector3f q = cloud[row].getVector3fMap() + away * direction.normalized();
    queries.push_back({q.x(), q.y(), q.z()});
  }
  return queries;
}

/// As of a depth camera that writes 0,0,0 where it saw nothing: runs of points in one place.
Cloud::Ptr withZeros(const Cloud& cloud) {
  constexpr std::size_t kRun = 100;
  auto out = pcl::make_shared<Cloud>(cloud);
  for (std::size_t i = 0; i < out->size(); ++i) {
    if (i / kRun % 3 == 0) (*out)[i] = {0.F, 0.F, 0.F};
  }
  return out;
}

double run(const std::string& name, const Cloud::Ptr& cloud, bool in_order,
           const std::vector<int>& counts) {
  search::MedianHash<pcl::PointXYZ> ours;
  pcl::search::KdTree<pcl::PointXYZ> theirs;
  ours.setInputCloud(cloud);
  theirs.setInputCloud(cloud);
  const float diagonal = diagonalOf(*cloud);
  double least = 1e9;
  std::printf("%s, %s\n", name.c_str(), in_order ? "in order" : "shuffled");
  for (const int k : counts) {
    for (const float away : {0.0F, 0.003F, 0.01F, 0.05F, 0.2F, 1.0F, 3.0F, 10.0F}) {
      const std::size_t count = std::min<std::size_t>(8000, cloud->size());
      const Cloud queries = queriesAway(*cloud, count, away * diagonal, in_order);
      pcl::Indices indices;
      std::vector<float> distances;
      const auto all = [&](const pcl::search::Search<pcl::PointXYZ>& search) {
        for (const auto& q : queries) search.nearestKSearch(q, k, indices, distances);
      };
      Race race;
      race.add("pcl", [&] { all(theirs); });
      race.add("median_hash", [&] { all(ours); });
      std::vector<Measurement> results;
      char task[32];
      std::snprintf(task, sizeof(task), "%g away", static_cast<double>(away));
      race.run(7, {name, in_order ? "ordered" : "shuffled", count, 1, task, "", k, 0.0, 0.0},
               results);
      least = std::min(least, results.back().times_as_fast);
    }
  }
  return least;
}

}  // namespace
}  // namespace segorient::benchmark

int main(int argc, char** argv) {
  using namespace segorient::benchmark;
  const std::size_t n = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 50000;
  std::vector<int> counts;
  for (int i = 2; i < argc; ++i) counts.push_back(std::atoi(argv[i]));
  if (counts.empty()) counts = {1, 10};
  const auto lidar = lidarLike(n, 2);
  const std::vector<std::pair<std::string, Cloud::Ptr>> clouds{
      {"surface", alongCurve(*bumpySphere(n, 1))},
      {"lidar", lidar},
      {"lidar with zeros", withZeros(*lidar)},
      {"uniform", alongCurve(*uniformCube(n, 3))}};
  double least = 1e9;
  for (const auto& [name, cloud] : clouds) {
    least = std::min(least, run(name, cloud, true, counts));
    auto shuffled = pcl::make_shared<Cloud>(*cloud);
    std::shuffle(shuffled->begin(), shuffled->end(), std::mt19937(4));
    least = std::min(least, run(name, shuffled, false, counts));
  }
  std::printf("least: %.2f times as fast as pcl::search::KdTree (%.1f asked for)\n", least,
              kLeastRatio);
  return least >= kLeastRatio ? 0 : 1;
}
