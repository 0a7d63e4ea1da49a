// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace segorient::program {

/// One line on a terminal that says which stage runs, how far the work is, how fast it goes and how
/// long it will take; nothing at all where standard error is no terminal.
///
/// A thread of its own keeps the line moving while a stage says nothing: it goes on at the mean
/// speed so far.
class ProgressBar {
 public:
  /// \param items what the work goes through, for the rate (points)
  ProgressBar(bool wanted, std::size_t items);
  ~ProgressBar();  ///< removes the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// \param stage its name
  /// \param fraction of the whole work that is done, 0 to 1
  void update(const std::string& stage, double fraction);
  /// What the work goes through, where it is known later.
  void setItems(std::size_t items) {
    const std::lock_guard<std::mutex> lock(mutex_);
    items_ = items;
  }
  /// The same as a function for the library's stages; this object must outlive it.
  std::function<void(const char* stage, double fraction)> callback() {
    return [this](const char* stage, double fraction) { update(stage, fraction); };
  }

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  void draw();

  std::mutex mutex_;  // guards all below
  std::size_t items_;
  std::condition_variable wake_;
  bool end_ = false;
  bool drawn_ = false;
  std::string stage_;
  double fraction_ = 0.0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point updated_ = begin_;
  std::thread thread_;  // not started where there is no terminal
};

}  // namespace segorient::program
