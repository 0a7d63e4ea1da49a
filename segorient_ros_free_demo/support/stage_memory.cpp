// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/stage_memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>

namespace segorient::program {

std::size_t peakMemory() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

bool resetPeakMemory() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;  // see proc(5)
  return file.good();
}

void StageMemory::begin(const std::string& stage) {
  if (stage == stage_) return;
  end();
  stage_ = stage;
  resetPeakMemory();
}

void StageMemory::end() {
  if (stage_.empty()) return;
  const std::size_t peak = peakMemory();
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
