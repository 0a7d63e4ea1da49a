// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/parts.h"

#include "common/parallel_for.h"

namespace segorient {

Parts::Parts(std::size_t size, int threads, double nanoseconds)
    : size_(size), count_(static_cast<std::size_t>(resolveThreads(threads, size, nanoseconds))) {}

void Parts::forEach(const std::function<void(std::size_t)>& work) const {
  constexpr double kAtOnce = 1e9;  // ns: one at a time
  parallelFor(count_, static_cast<int>(count_), kAtOnce, work);
}

}  // namespace segorient
