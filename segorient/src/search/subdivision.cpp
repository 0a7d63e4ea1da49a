// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <omp.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/box.h"
#include "common/parallel_for.h"
#include "search/layout.h"

namespace segorient::search {
namespace {

// Fewer points than this are a task of their own no longer.
constexpr std::size_t kTaskSize = 20000;

Box boxOf(const BuildPoint* points, std::size_t count) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float lo[3] = {kInfinity, kInfinity, kInfinity};
  float hi[3] = {-kInfinity, -kInfinity, -kInfinity};
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) {
      const float v = points[i].xyz[a];
      lo[a] = v < lo[a] ? v : lo[a];
      hi[a] = v > hi[a] ? v : hi[a];
    }
  }
  return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

Box merged(const Box& a, const Box& b) {
  Box box;
  for (int i = 0; i < 3; ++i) {
    box.lo[i] = std::min(a.lo[i], b.lo[i]);
    box.hi[i] = std::max(a.hi[i], b.hi[i]);
  }
  return box;
}

// Up to so many points, all of them are looked at instead of a sample.
constexpr std::size_t kFewPoints = 200;

// An interval that the element of a rank is most likely in; of few points, its coordinate twice.
struct Estimate {
  float lo, hi;
};

// Every `stride`-th point is the sample.
std::size_t sampleSize(std::size_t count) {
  return count <= kFewPoints ? count
                             : std::min(std::max<std::size_t>(count / 16, 64), std::size_t{1024});
}

Estimate estimate(const BuildPoint* points, std::size_t count, std::size_t rank, std::size_t axis) {
  std::array<float, 1024> sample{};
  const std::size_t size = sampleSize(count);
  for (std::size_t i = 0; i < size; ++i) sample[i] = points[i * count / size].xyz[axis];
  // 2 standard deviations of the rank, which is at most that of a fair coin.
  const bool all = size == count;
  const auto deviation =
      all ? 0 : static_cast<std::size_t>(std::sqrt(static_cast<double>(size))) + 1;
  const std::size_t middle = all ? rank : rank * size / count;
  const std::size_t low = middle - std::min(deviation, middle);
  const std::size_t high = std::min(middle + deviation, size - 1);
  float* const end = sample.data() + size;
  std::nth_element(sample.data(), sample.data() + low, end);
  const float lo = sample[low];
  if (high > low) std::nth_element(sample.data() + low + 1, sample.data() + high, end);
  return {lo, sample[high]};
}

std::size_t longestAxisOfSample(const BuildPoint* points, std::size_t count) {
  std::array<BuildPoint, 256> sample;
  const std::size_t size = std::min(sample.size(), count);
  for (std::size_t i = 0; i < size; ++i) sample[i] = points[i * count / size];
  const Box box = boxOf(sample.data(), size);
  return longestAxis(box.lo, box.hi);
}

// Each step but the last keeps less than half of its points for the next one; what they take is
// less than there are points, and one place more for each of at most 32 steps.
constexpr std::size_t kMoreScratch = 64;

// Copies to `to`, the `half` points of the least coordinates in front. What is below or above an
// estimated interval is in place after one pass without a branch; the rest is divided likewise.
// \param scratch room for `count` points and kMoreScratch more
// \return the least coordinate behind
float divideInTwo(const BuildPoint* from, std::size_t count, BuildPoint* to, std::size_t half,
                  std::size_t axis, BuildPoint* scratch) {
  const Estimate guess = estimate(from, count, half, axis);
  BuildPoint* const inside = scratch;
  std::size_t left = 0;
  std::size_t right = count;
  std::size_t middle = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const BuildPoint p = from[i];
    const float v = p.xyz[axis];
    const bool below = v < guess.lo;
    const bool above = v > guess.hi;
    to[left] = p;
    to[right - 1] = p;
    inside[middle] = p;
    left += below ? 1 : 0;
    right -= above ? 1 : 0;
    middle += below || above ? 0 : 1;
  }
  const bool found = left <= half && half < left + middle;
  if (found && guess.lo < guess.hi && middle < count / 2) {
    return divideInTwo(inside, middle, to + left, half - left, axis, inside + middle + 1);
  }
  std::copy(inside, inside + middle, to + left);
  if (!found || guess.lo < guess.hi) {
    // The estimate was wrong, or many coordinates are nearly equal.
    std::nth_element(to, to + half, to + count, [axis](const BuildPoint& p, const BuildPoint& q) {
      return p.xyz[axis] < q.xyz[axis];
    });
  }
  return to[half].xyz[axis];
}

class Subdivision {
 public:
  Subdivision(BuildPoint* points, BuildPoint* other, std::size_t levels, std::size_t threads,
              Layout& layout)
      : points_(points), other_(other), levels_(levels), layout_(layout), scratch_(threads) {
    layout.boxes.resize(std::size_t{2} << levels);
    layout.splits.resize(std::size_t{1} << levels);
    layout.regions.resize(std::size_t{1} << levels);
  }

  // \return the points region by region, in one of the two arrays
  BuildPoint* run(std::size_t count) {
    const auto threads = static_cast<int>(scratch_.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
#pragma omp single
    divide(1, 0, 0, count);
    error_.rethrow();
    for (std::size_t node = layout_.regions.size() - 1; node > 0; --node) {
      layout_.boxes[node] = merged(layout_.boxes[2 * node], layout_.boxes[2 * node + 1]);
    }
    return levels_ % 2 == 0 ? points_ : other_;
  }

 private:
  void divide(std::size_t node, std::size_t level, std::size_t begin, std::size_t end) {
    const BuildPoint* from = (level % 2 == 0 ? points_ : other_) + begin;
    const std::size_t count = end - begin;
    if (level == levels_) {
      layout_.boxes[node] = boxOf(from, count);
      Region& region = layout_.regions[node - layout_.regions.size()];
      region.begin = static_cast<std::uint32_t>(begin);
      region.end = static_cast<std::uint32_t>(end);
      return;
    }
    const std::size_t half = count / 2;
    error_.guard(node, [&] {
      FastVector<BuildPoint>& scratch = scratch_[static_cast<std::size_t>(omp_get_thread_num())];
      scratch.clear();
      scratch.resize(count + kMoreScratch);
      const std::size_t axis = longestAxisOfSample(from, count);
      BuildPoint* to = (level % 2 == 0 ? other_ : points_) + begin;
      const float value = divideInTwo(from, count, to, half, axis, scratch.data());
      layout_.splits[node] = {value, static_cast<std::uint32_t>(axis)};
    });
    if (error_.failed()) return;
    const std::size_t middle = begin + half;
#pragma omp task if (count > kTaskSize)
    divide(2 * node, level + 1, begin, middle);
#pragma omp task if (count > kTaskSize)
    divide(2 * node + 1, level + 1, middle, end);
#pragma omp taskwait
  }

  BuildPoint* points_;
  BuildPoint* other_;
  std::size_t levels_;
  Layout& layout_;
  std::vector<FastVector<BuildPoint>> scratch_;  // by thread
  ParallelError error_;
};

}  // namespace

BuildPoint* subdivide(BuildPoint* points, BuildPoint* other, std::size_t count, std::size_t levels,
                      int threads, Layout& layout) {
  const auto team = static_cast<std::size_t>(std::clamp(threads, 1, omp_get_thread_limit()));
  return Subdivision(points, other, levels, team, layout).run(count);
}

}  // namespace segorient::search
