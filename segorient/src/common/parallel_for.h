// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

#include "common/threads.h"

namespace segorient {

/// The first exception of what runs in an OpenMP region, which none may leave.
class ParallelError {
 public:
  /// Calls work(). \param order of two that throw, the one with less is first
  template <typename Work>
  void guard(const std::size_t& order, Work&& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!failed_ || order < order_) error_ = std::current_exception();
      order_ = failed_ ? std::min(order, order_) : order;
      failed_ = true;
    }
  }
  bool failed() const { return failed_; }

  /// Throws it again, after the region.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> failed_{false};
  std::size_t order_ = 0;
  std::exception_ptr error_;
};

/// Time of one call in the mean, where `count` calls share some items.
inline double timeOfEach(std::size_t count, std::size_t items, double nanoseconds) {
  return nanoseconds * static_cast<double>(items) / std::max(1.0, static_cast<double>(count));
}

/// Calls work(i, space) for each i below count, in no certain order and on as many threads as that
/// is worth, each with a space of its own that it makes first. Throws what the first of them
/// throws, by i.
/// \param threads and \param nanoseconds of one call, about: see resolveThreads()
template <typename MakeSpace, typename Work>
void parallelFor(std::size_t count, int threads, double nanoseconds, const MakeSpace& makeSpace,
                 const Work& work) {
  // Long enough that nobody waits for the next one, short enough that nobody waits at the end.
  constexpr double kRun = 1e5;
  if (count == 0) return;
  const int team = resolveThreads(threads, count, nanoseconds);
  const auto run = static_cast<std::size_t>(std::max(1.0, kRun / std::max(1.0, nanoseconds)));
  std::atomic<std::size_t> next{0};
  ParallelError error;
  onEachThread(team, [&] {
    std::size_t begin = next.fetch_add(run);
    error.guard(begin, [&] {
      if (begin >= count) return;
      auto space = makeSpace();
      // What has begun is done, so that it is always the same exception that is thrown.
      for (; begin < count; begin = error.failed() ? count : next.fetch_add(run)) {
        const std::size_t end = std::min(count, begin + run);
        for (std::size_t i = begin; i < end; ++i) work(i, space);
      }
    });
  });
  error.rethrow();
}

/// The same with work(i).
template <typename Work>
void parallelFor(std::size_t count, int threads, double nanoseconds, const Work& work) {
  parallelFor(
      count, threads, nanoseconds, [] { return 0; }, [&work](std::size_t i, int) { work(i); });
}

}  // namespace segorient
