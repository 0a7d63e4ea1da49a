// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Asks the system, and can do without an answer.
#include "common/peak_memory.h"

#if defined(_WIN32)
#define PSAPI_VERSION 2  // in kernel32 itself
#include <windows.h>
// Needs windows.h before it.
#include <psapi.h>
#elif defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

namespace segorient {

std::size_t peakMemory() {
#if defined(_WIN32)
  PROCESS_MEMORY_COUNTERS counters{};
  if (GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters)) != 0) {
    return counters.PeakWorkingSetSize;
  }
#elif defined(__APPLE__)
  rusage usage{};  // in bytes
  if (getrusage(RUSAGE_SELF, &usage) == 0) return static_cast<std::size_t>(usage.ru_maxrss);
#elif defined(__unix__)
  rusage usage{};  // in KiB
  if (getrusage(RUSAGE_SELF, &usage) == 0) return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
#endif
  return 0;
}

}  // namespace segorient
