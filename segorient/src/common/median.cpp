// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/median.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace segorient {

namespace {

// Of so many values it pays to look at a sample first.
constexpr std::size_t kMany = 1U << 14U;
constexpr std::size_t kSample = 1024;
// Of ranks in the sample: three standard deviations of a fair coin, sqrt(kSample) / 2 each.
constexpr std::size_t kMargin = 48;

// Leaves of many values those that the sample says the middle is among, in one pass, and changes
// the rank accordingly. Changes nothing where the sample was wrong.
void narrow(std::vector<float>& values, std::size_t& rank) {
  std::vector<float> sample(kSample);
  for (std::size_t i = 0; i < kSample; ++i) sample[i] = values[i * values.size() / kSample];
  std::sort(sample.begin(), sample.end());
  const float low = sample[kSample / 2 - kMargin];
  const float high = sample[kSample / 2 + kMargin];
  std::vector<float> inside;
  std::size_t below = 0;
  for (const float v : values) {
    below += v < low ? 1 : 0;
    if (v >= low && v <= high) inside.push_back(v);
  }
  if (rank < below || rank >= below + inside.size()) return;
  rank -= below;
  values = std::move(inside);
}

}  // namespace

float median(std::vector<float> values) {
  if (values.empty()) return 0.F;
  std::size_t rank = values.size() / 2;
  if (values.size() >= kMany) narrow(values, rank);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace segorient
