// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/stage_clock.h"

#include <algorithm>
#include <cstring>

namespace segorient::detail {

void StageClock::begin(const char* stage, double fraction) {
  if (stage_ == nullptr || std::strcmp(stage_, stage) != 0) {
    end();
    stage_ = stage;
    start_ = Clock::now();
  }
  if (progress_) progress_(stage, fraction);
}

void StageClock::end() {
  if (stage_ == nullptr) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  auto own = std::find_if(times_.begin(), times_.end(),
                          [this](const StageTime& time) { return time.stage == stage_; });
  if (own == times_.end()) own = times_.insert(own, {stage_, 0.0});
  own->seconds += seconds;
  stage_ = nullptr;
}

}  // namespace segorient::detail
