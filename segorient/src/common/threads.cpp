// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/threads.h"

#include <omp.h>

#include <algorithm>

namespace segorient {

int resolveThreads(int requested) {
  if (requested < 0) return 1;
  // More than the machine has of them only cost, and thousands are more than a system gives. Tests
  // of what threads do want a few even on a small machine.
  constexpr int kAlwaysGiven = 64;
  if (requested > 0) return std::min(requested, std::max(kAlwaysGiven, omp_get_num_procs()));
  return std::max(1, omp_get_max_threads());
}

int resolveThreads(int requested, std::size_t items, double nanoseconds) {
  // Linux and others let a program go on for 3 to 6 ms while others wait: twice that, so that
  // waiting for a slice costs less than is saved.
  constexpr double kWorthAThread = 1e7;
  const int threads = resolveThreads(requested);
  if (requested != 0) return threads;
  const double worth = static_cast<double>(items) * nanoseconds / kWorthAThread;
  return worth < threads ? std::max(1, static_cast<int>(worth)) : threads;
}

void onEachThread(int threads, const std::function<void()>& work) {
#pragma omp parallel num_threads(threads) if (threads > 1)
  work();
}

}  // namespace segorient
