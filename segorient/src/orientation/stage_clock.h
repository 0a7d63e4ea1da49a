// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>

#include <chrono>
#include <vector>

namespace segorient::detail {

/// Says which stage is running, and keeps the time of each. A stage may be taken up again.
class StageClock {
 public:
  explicit StageClock(PipelineProgress progress) : progress_(std::move(progress)) {}

  /// Ends the stage before; also called as a stage goes on.
  void begin(const char* stage, double fraction);
  void end();
  /// \return each stage once, in the order in which they began
  const std::vector<StageTime>& times() const { return times_; }

 private:
  using Clock = std::chrono::steady_clock;
  PipelineProgress progress_;
  std::vector<StageTime> times_;
  const char* stage_ = nullptr;
  Clock::time_point start_;
};

}  // namespace segorient::detail
