// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "io/errors.h"

namespace segorient::program {
namespace {

constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

// A file that holds one number; "max", or no file, means no limit.
std::size_t numberIn(const char* path) {
  std::ifstream file(path);
  std::size_t value = 0;
  return file >> value ? value : kUnknown;
}

std::size_t leftInGroup() {
  const std::size_t limit = numberIn("/sys/fs/cgroup/memory.max");
  const std::size_t used = numberIn("/sys/fs/cgroup/memory.current");
  if (limit == kUnknown || used == kUnknown) return kUnknown;
  return limit - std::min(limit, used);
}

// ulimit -v
std::size_t leftInAddressSpace() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  const std::size_t pages = numberIn("/proc/self/statm");
  if (pages == kUnknown) return kUnknown;
  const auto all = static_cast<std::size_t>(limit.rlim_cur);
  return all - std::min(all, pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
}

std::string amount(std::size_t bytes) {
  char text[32];
  const bool large = bytes >= 1000000000;
  std::snprintf(text, sizeof text, large ? "%.1f GB" : "%.0f MB",
                static_cast<double>(bytes) / (large ? 1e9 : 1e6));
  return text;
}

}  // namespace

std::size_t availableIn(std::istream& meminfo) {
  std::string line;
  while (std::getline(meminfo, line)) {
    unsigned long long kilobytes = 0;
    if (std::sscanf(line.c_str(), "MemAvailable: %llu kB", &kilobytes) == 1) {
      return static_cast<std::size_t>(kilobytes) * 1024;
    }
  }
  return kUnknown;
}

std::size_t availableMemory() {
  std::ifstream meminfo("/proc/meminfo");
  return std::min({availableIn(meminfo), leftInGroup(), leftInAddressSpace()});
}

void requireMemory(const std::string& file, std::size_t needed, std::size_t available) {
  if (needed <= available) return;
  throw FileError(file, "takes about " + amount(needed) + " of memory to work on, and " +
                            amount(available) + " are free");
}

}  // namespace segorient::program
