// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace segorient::benchmark {

/// One measured time.
struct Measurement {
  std::string cloud, order;
  std::size_t points;
  unsigned int threads;
  std::string task, method;
  int k;                 ///< 0 where the task has none
  double nanoseconds;    ///< for one point, median
  double times_as_fast;  ///< as the first method of the race
};

/// Methods that do the same, measured in turn, so that all of them meet the same load of the
/// machine.
class Race {
 public:
  using Work = std::function<void()>;
  void add(const std::string& method, Work work) {
    entries_.push_back({method, std::move(work), {}});
  }

  /// Runs all `runs` times and prints how they compare.
  /// \param like cloud, task and so on; the rest is filled in
  void run(int runs, const Measurement& like, std::vector<Measurement>& results) {
    for (int r = 0; r < runs; ++r) {
      for (auto& entry : entries_) {
        const double start = now(like.threads);
        entry.work();
        entry.seconds.push_back(now(like.threads) - start);
      }
    }
    std::printf("  %-18s",
                (like.task + (like.k > 0 ? ", k = " + std::to_string(like.k) : "")).c_str());
    for (auto& entry : entries_) {
      Measurement m = like;
      m.method = entry.method;
      m.nanoseconds = 1e9 * median(entry.seconds) / static_cast<double>(like.points);
      m.times_as_fast = median(entries_.front().seconds) / median(entry.seconds);
      if (&entry == &entries_.front()) {
        std::printf(" %s %.0f ns", m.method.c_str(), m.nanoseconds);
      } else {
        std::printf(" | %s %.2f", m.method.c_str(), m.times_as_fast);
      }
      results.push_back(m);
    }
    std::printf("\n");
    std::fflush(stdout);
  }

 private:
  struct Entry {
    std::string method;
    Work work;
    std::vector<double> seconds;
  };

  // Processor time where one thread works, so that other programs matter less.
  static double now(unsigned int threads) {
    if (threads == 1) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }

  std::vector<Entry> entries_;
};

/// Calls work(begin, end) for parts of a range, on as many threads (0 = all cores).
inline void inParts(std::size_t count, unsigned int threads,
                    const std::function<void(std::size_t, std::size_t)>& work) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  if (threads == 1) return work(0, count);
  std::vector<std::thread> pool;
  for (unsigned int t = 0; t < threads; ++t) {
    pool.emplace_back(work, count * t / threads, count * (t + 1) / threads);
  }
  for (auto& thread : pool) thread.join();
}

}  // namespace segorient::benchmark
