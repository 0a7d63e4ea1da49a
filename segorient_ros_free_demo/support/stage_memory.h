// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "support/json.h"

namespace segorient::program {

/// The most memory that the process had during each stage of its work. Linux keeps one high-water
/// mark a process, which is set back where a stage begins; where that is not allowed, a stage has
/// the most so far. It may do so because the process is ours: a library may not.
class StageMemory {
 public:
  /// Ends the stage before and begins another one; nothing if that goes on. One that comes again is
  /// counted with what it had before.
  void begin(const std::string& stage);
  void end();

  /// Tells `next` what it is told, and begins the stages that it hears of. This object and what
  /// `next` needs must outlive it.
  PipelineProgress watch(PipelineProgress next);

  /// In the order they began; bytes, the input and whatever else is in memory included.
  const std::vector<std::pair<std::string, std::size_t>>& stages() const { return stages_; }
  std::size_t most() const;  ///< of all stages

 private:
  std::string stage_;
  std::vector<std::pair<std::string, std::size_t>> stages_;
};

/// As the object `peak_memory_bytes_by_stage` of a report.
void addTo(JsonWriter& json, const StageMemory& memory);

/// The process's high-water mark in bytes, 0 where it is not known.
std::size_t peakMemory();
/// Sets it back to what is in use. \return whether that is allowed
bool resetPeakMemory();

}  // namespace segorient::program
