// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/peak_memory.h"

#if defined(__unix__)
#include <sys/resource.h>
#endif

namespace segorient {

std::size_t peakMemory() {
#if defined(__unix__)
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) == 0) return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
#endif
  return 0;
}

}  // namespace segorient
