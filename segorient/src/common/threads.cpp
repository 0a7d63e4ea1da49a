// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/threads.h>

#include <omp.h>

#include <algorithm>

namespace segorient {

int resolveThreads(int requested) {
  if (requested > 0) return requested;
  if (requested < 0) return 1;
  return std::max(1, omp_get_max_threads());
}

}  // namespace segorient
