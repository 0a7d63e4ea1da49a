// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace segorient::program {
namespace {

constexpr double kBarWidth = 24.0;
constexpr std::chrono::milliseconds kBetweenDraws{150};

std::string rateText(double per_second) {
  char text[32];
  if (per_second >= 1e6) {
    std::snprintf(text, sizeof(text), "%.1f M points/s", per_second * 1e-6);
  } else {
    std::snprintf(text, sizeof(text), "%.0f k points/s", per_second * 1e-3);
  }
  return text;
}

}  // namespace

ProgressBar::ProgressBar(bool wanted, std::size_t items) : items_(items) {
  if (wanted && isatty(STDERR_FILENO) == 1) thread_ = std::thread(&ProgressBar::run, this);
}

ProgressBar::~ProgressBar() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void ProgressBar::update(const std::string& stage, double fraction) {
  if (!thread_.joinable()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  stage_ = stage;
  fraction_ = std::clamp(fraction, 0.0, 1.0);
  updated_ = Clock::now();
}

void ProgressBar::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!wake_.wait_for(lock, kBetweenDraws, [this] { return end_; })) draw();
  if (drawn_) std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void ProgressBar::draw() {
  if (stage_.empty()) return;
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  const Clock::time_point now = Clock::now();
  const double until_update = seconds(updated_ - begin_);
  const double speed = until_update > 0.0 ? fraction_ / until_update : 0.0;
  const double fraction = std::min(0.99, fraction_ + speed * seconds(now - updated_));
  const auto filled = static_cast<std::size_t>(fraction * kBarWidth);
  const std::string bar =
      std::string(filled, '#') + std::string(static_cast<std::size_t>(kBarWidth) - filled, '.');
  std::fprintf(stderr, "\r\033[K%-13s [%s] %3.0f %%", stage_.c_str(), bar.c_str(),
               100.0 * fraction);
  if (speed > 0.0 && items_ > 0) {
    std::fprintf(stderr, "  %s  %.0f s left", rateText(speed * static_cast<double>(items_)).c_str(),
                 (1.0 - fraction) / speed);
  } else {
    std::fprintf(stderr, "  %.0f s", seconds(now - begin_));
  }
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace segorient::program
