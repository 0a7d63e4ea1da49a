// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/space_order.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/threads.h"

namespace segorient::program {
namespace {

// The lowest 21 bits of a number, two free bits after each.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

constexpr double kCells = 2097151.0;   // a side, in 21 bits
constexpr unsigned kBucketShift = 51;  // the highest 12 of 63 bits: 16 cells a side
constexpr std::size_t kBuckets = 4096;

struct Keyed {
  std::uint64_t key;
  std::uint32_t rank;
  std::uint32_t row;

  std::size_t bucket() const { return key >> kBucketShift; }
  bool operator<(const Keyed& other) const {
    return key != other.key ? key < other.key : rank < other.rank;
  }
};

// By buckets of their highest bits first, which are then sorted side by side.
std::vector<Keyed> sorted(const std::vector<Keyed>& keyed, int threads) {
  std::vector<std::size_t> ends(kBuckets + 1, 0);
  for (const Keyed& k : keyed) ++ends[k.bucket() + 1];
  for (std::size_t b = 0; b < kBuckets; ++b) ends[b + 1] += ends[b];
  std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
  std::vector<Keyed> out(keyed.size());
  for (const Keyed& k : keyed) out[next[k.bucket()]++] = k;
  const auto at = [&](std::size_t i) { return out.begin() + static_cast<std::ptrdiff_t>(i); };
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t b = 0; b < kBuckets; ++b) std::sort(at(ends[b]), at(ends[b + 1]));
  return out;
}

}  // namespace

void sortInSpace(const PointView& points, std::vector<std::uint32_t>::iterator first,
                 std::vector<std::uint32_t>::iterator last, int threads) {
  std::array<double, 3> low;
  std::array<double, 3> high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  for (auto row = first; row != last; ++row) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], static_cast<double>(points[*row][a]));
      high[a] = std::max(high[a], static_cast<double>(points[*row][a]));
    }
  }
  double extent = 0.0;
  for (std::size_t a = 0; a < 3; ++a) extent = std::max(extent, high[a] - low[a]);
  if (!(extent > 0.0)) return;
  const int workers = resolveThreads(threads);
  const std::ptrdiff_t count = last - first;
  std::vector<Keyed> keyed(static_cast<std::size_t>(count));
#pragma omp parallel for schedule(static, 4096) num_threads(workers)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::uint32_t row = first[i];
    std::uint64_t key = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double cell = (static_cast<double>(points[row][a]) - low[a]) / extent * kCells;
      key |= spread(static_cast<std::uint64_t>(cell)) << a;
    }
    keyed[static_cast<std::size_t>(i)] = {key, static_cast<std::uint32_t>(i), row};
  }
  keyed = sorted(keyed, workers);
  std::transform(keyed.begin(), keyed.end(), first, [](const Keyed& k) { return k.row; });
}

}  // namespace segorient::program
