// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/stage_memory.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <system_error>

namespace segorient::program {
namespace {

constexpr std::chrono::milliseconds kBetweenSamples{2};

std::size_t highWaterMark() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

// Bytes in use, from an open /proc/self/statm; 0 where it says nothing. Allocates nothing: in a
// thread the first allocation would take an arena's worth of addresses.
std::size_t inUse(int file) {
  char text[128];
  const ssize_t length = pread(file, text, sizeof(text) - 1, 0);
  if (length <= 0) return 0;
  text[length] = '\0';
  unsigned long long pages = 0;
  if (std::sscanf(text, "%*u %llu", &pages) != 1) return 0;
  return static_cast<std::size_t>(pages) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

StageMemory::StageMemory(bool wanted) {
  if (!wanted) return;
  file_ = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file_ < 0) return;
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    // Then there are two samples a stage, at its ends.
  }
}

StageMemory::~StageMemory() {
  if (thread_.joinable()) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      end_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  if (file_ >= 0) close(file_);
}

void StageMemory::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!end_) {
    sample();
    wake_.wait_for(lock, kBetweenSamples);
  }
}

void StageMemory::sample() {
  if (file_ >= 0) sampled_ = std::max(sampled_, inUse(file_));
}

void StageMemory::begin(const std::string& stage) {
  if (stage == stage_) return;
  end();
  stage_ = stage;
  mark_ = highWaterMark();
  const std::lock_guard<std::mutex> lock(mutex_);
  sampled_ = 0;
  sample();
}

void StageMemory::end() {
  if (stage_.empty()) return;
  std::size_t peak = highWaterMark();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    sample();
    // Nothing known but the mark: then this is the most so far.
    if (peak <= mark_ && sampled_ > 0) peak = std::min(sampled_, peak);
  }
  const auto before = std::find_if(stages_.begin(), stages_.end(),
                                   [this](const auto& s) { return s.first == stage_; });
  if (before == stages_.end()) {
    stages_.emplace_back(stage_, peak);
  } else {
    before->second = std::max(before->second, peak);
  }
  stage_.clear();
}

PipelineProgress StageMemory::watch(PipelineProgress next) {
  return [this, next](const char* stage, double fraction) {
    begin(stage);
    if (next) next(stage, fraction);
  };
}

std::size_t StageMemory::most() const {
  std::size_t most = 0;
  for (const auto& s : stages_) most = std::max(most, s.second);
  return most;
}

void addTo(JsonWriter& json, const StageMemory& memory) {
  json.beginObject("peak_memory_bytes_by_stage");
  for (const auto& [stage, bytes] : memory.stages()) json.field(stage, bytes);
  json.endObject();
}

}  // namespace segorient::program
