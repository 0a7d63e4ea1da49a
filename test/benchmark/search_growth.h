// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/search/median_hash.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark_clouds.h"

namespace segorient::benchmark {

/// How the all-points searches of one kind of cloud grow with its size and with a second thread:
/// one index on few points, two on many, measured in turn.
class Growth {
 public:
  using Tree = search::MedianHash<pcl::PointXYZ>;

  Growth(std::string name, const Cloud::Ptr& few, const Cloud::Ptr& many, std::size_t runs)
      : name_(std::move(name)), runs_(runs) {
    const std::pair<Cloud::Ptr, unsigned int> inputs[3] = {{few, 1}, {many, 1}, {many, 2}};
    for (int i = 0; i < 3; ++i) {
      size_[i] = static_cast<double>(inputs[i].first->size());
      tree_[i].setNumberOfThreads(inputs[i].second);
      tree_[i].setInputCloud(inputs[i].first);
    }
  }

  /// \param radius of the small cloud and of the large one
  void run(const std::vector<std::size_t>& ks, const double (&radius)[2]) {
    for (const std::size_t k : ks) {
      Neighborhoods table;
      measure("k = " + std::to_string(k),
              [&](int i) { tree_[i].nearestKSearchAll(static_cast<int>(k), table); });
    }
    RadiusNeighborhoods few;
    RadiusNeighborhoods many;
    measure("radius of 20",
            [&](int i) { tree_[i].radiusSearchAll(radius[i > 0 ? 1 : 0], i > 0 ? many : few); });
  }

 private:
  void measure(const std::string& task, const std::function<void(int)>& search) {
    using Clock = std::chrono::steady_clock;
    std::vector<double> times[3];
    for (std::size_t r = 0; r < runs_; ++r) {
      for (int i = 0; i < 3; ++i) {
        const auto start = Clock::now();
        search(i);
        times[i].push_back(std::chrono::duration<double>(Clock::now() - start).count() / size_[i]);
      }
    }
    double median[3];
    for (int i = 0; i < 3; ++i) {
      std::sort(times[i].begin(), times[i].end());
      median[i] = times[i][runs_ / 2];
    }
    std::printf("%s, %s: %.0f ns a point of %.0f | of %.0f %.2f times | two threads %.2f\n",
                name_.c_str(), task.c_str(), 1e9 * median[0], size_[0], size_[1],
                median[1] / median[0], median[1] / median[2]);
    std::fflush(stdout);
  }

  std::string name_;
  std::size_t runs_;
  Tree tree_[3];
  double size_[3];
};

}  // namespace segorient::benchmark
