// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/space_order.h"

#include <algorithm>
#include <array>
#include <limits>

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

}  // namespace

void sortInSpace(const PointView& points, std::vector<std::uint32_t>::iterator first,
                 std::vector<std::uint32_t>::iterator last) {
  constexpr double kCells = 2097151.0;
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
  struct Keyed {
    std::uint64_t key;
    std::uint32_t rank;
    std::uint32_t row;
  };
  std::vector<Keyed> keyed;
  keyed.reserve(static_cast<std::size_t>(last - first));
  for (auto row = first; row != last; ++row) {
    std::uint64_t key = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double cell = (static_cast<double>(points[*row][a]) - low[a]) / extent * kCells;
      key |= spread(static_cast<std::uint64_t>(cell)) << a;
    }
    keyed.push_back({key, static_cast<std::uint32_t>(keyed.size()), *row});
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.key != b.key ? a.key < b.key : a.rank < b.rank;
  });
  std::transform(keyed.begin(), keyed.end(), first, [](const Keyed& k) { return k.row; });
}

}  // namespace segorient::program
