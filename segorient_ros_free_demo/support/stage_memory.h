// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/json.h"

namespace segorient::program {

/// The most memory that the process had during each stage of its work.
///
/// Linux keeps one high-water mark a process. It is exact for a stage that raises it; what lies
/// below is read by a thread of its own every two milliseconds. The mark is not set back, although
/// that is possible: it would be wrong for whoever measures the process from outside.
class StageMemory {
 public:
  explicit StageMemory(bool wanted);
  ~StageMemory();
  StageMemory(const StageMemory&) = delete;
  StageMemory& operator=(const StageMemory&) = delete;

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
  void run();
  void sample();

  int file_ = -1;  // says what is in use; kept open, as opening takes most of the time
  std::string stage_;
  std::vector<std::pair<std::string, std::size_t>> stages_;
  std::size_t mark_ = 0;  // high-water mark when the stage began
  std::mutex mutex_;      // guards all below
  std::condition_variable wake_;
  bool end_ = false;
  std::size_t sampled_ = 0;  // most that was seen in this stage
  std::thread thread_;       // not started where nobody wants to know, or threads have run out
};

/// As the object `peak_memory_bytes_by_stage` of a report.
void addTo(JsonWriter& json, const StageMemory& memory);

}  // namespace segorient::program
