// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/parts.h"

#include "common/threads.h"

namespace segorient {

Parts::Parts(std::size_t size, int threads, double nanoseconds)
    : size_(size), count_(static_cast<std::size_t>(resolveThreads(threads, size, nanoseconds))) {}

void Parts::forEach(const std::function<void(std::size_t)>& work) const {
#pragma omp parallel for schedule(static, 1) num_threads(static_cast <int>(count_))
  for (std::size_t part = 0; part < count_; ++part) work(part);
}

}  // namespace segorient
