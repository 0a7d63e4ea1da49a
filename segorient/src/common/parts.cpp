// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/parts.h"

#include <exception>

#include "common/threads.h"

namespace segorient {

Parts::Parts(std::size_t size, int threads, double nanoseconds)
    : size_(size), count_(static_cast<std::size_t>(resolveThreads(threads, size, nanoseconds))) {}

void Parts::forEach(const std::function<void(std::size_t)>& work) const {
  // No exception may leave a thread.
  std::exception_ptr failure;
  std::size_t failed = count_;
#pragma omp parallel for schedule(static, 1) num_threads(static_cast <int>(count_))
  for (std::size_t part = 0; part < count_; ++part) {
    try {
      work(part);
    } catch (...) {
#pragma omp critical(segorient_parts)
      if (part < failed) {
        failed = part;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace segorient
