// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/page/space_order.h"

namespace segorient::program {
namespace {

// The first radius is the extent over this; some hundred points then stand for a surface.
constexpr double kFirstLevel = 16.0;
constexpr int kLevels = 16;
constexpr std::size_t kFirstPoints = 10'000;  // so many are drawn in any case, whatever their order

using Cell = std::array<std::int32_t, 3>;

std::uint64_t mixed(std::uint64_t h) {  // a bijection that leaves no pattern
  h ^= h >> 31;
  h *= 0x9e3779b97f4a7c15ULL;
  h ^= h >> 29;
  h *= 0xd6e8feb86659fd93ULL;
  return h ^ h >> 32;
}

std::uint64_t hashOf(const float* p) {
  std::uint64_t hash = 0;
  for (int a = 0; a < 3; ++a) {
    const float value = p[a] == 0.F ? 0.F : p[a];  // -0 is the same place
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    hash = mixed(hash + bits + 1);
  }
  return hash;
}

// Accepted points by cells as wide as the radius: an open table whose entries are chained by cell.
class Grid {
 public:
  Grid(const PointView& points, const std::array<float, 3>& low, double radius, std::size_t room)
      : points_(points), low_(low), radius_(radius) {
    std::size_t size = 64;
    while (size < 2 * room) size *= 2;
    first_.assign(size, kNone);
  }
  bool isFree(std::uint32_t row) const {
    const Cell own = cellOf(row);
    // Its own cell first: that is where points near it are likeliest.
    if (!isFreeOf(row, own)) return false;
    for (int i = 0; i < 27; ++i) {
      const Cell cell{own[0] + i % 3 - 1, own[1] + i / 3 % 3 - 1, own[2] + i / 9 - 1};
      if (cell != own && !isFreeOf(row, cell)) return false;
    }
    return true;
  }
  void add(std::uint32_t row) {
    std::uint32_t& first = first_[slot(cellOf(row))];
    rows_.push_back(row);
    next_.push_back(first);
    first = static_cast<std::uint32_t>(rows_.size() - 1);
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  Cell cellOf(std::uint32_t row) const {
    Cell cell{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double offset = static_cast<double>(points_[row][a]) - static_cast<double>(low_[a]);
      cell[a] = static_cast<std::int32_t>(offset / radius_);
    }
    return cell;
  }
  std::size_t slot(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int32_t c : cell) hash = mixed(hash + static_cast<std::uint32_t>(c) + 1);
    return hash & (first_.size() - 1);
  }
  bool isFreeOf(std::uint32_t row, const Cell& cell) const {
    const float* p = points_[row];
    for (std::uint32_t i = first_[slot(cell)]; i != kNone; i = next_[i]) {
      const float* q = points_[rows_[i]];
      double sum = 0.0;
      for (int a = 0; a < 3; ++a) {
        const double d = static_cast<double>(p[a]) - static_cast<double>(q[a]);
        sum += d * d;
      }
      if (sum < radius_ * radius_) return false;
    }
    return true;
  }

  const PointView& points_;
  std::array<float, 3> low_;
  double radius_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> rows_;
  std::vector<std::uint32_t> next_;
};

// Finite rows by the hash of their places; equal places by row.
std::vector<std::uint32_t> darts(const PointView& points) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
  keyed.reserve(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (isFinite(points[i])) keyed.emplace_back(hashOf(points[i]), static_cast<std::uint32_t>(i));
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> rows(keyed.size());
  std::transform(keyed.begin(), keyed.end(), rows.begin(), [](const auto& k) { return k.second; });
  return rows;
}

}  // namespace

std::vector<std::uint32_t> blueNoiseOrder(const PointView& points, std::size_t most) {
  std::vector<std::uint32_t> rest = darts(points);
  std::vector<std::uint32_t> order;
  if (rest.empty()) return order;
  most = std::min(most, rest.size());
  order.reserve(most);
  std::array<float, 3> low;
  low.fill(std::numeric_limits<float>::max());
  double extent = 0.0;
  for (const std::uint32_t row : rest) {
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], points[row][a]);
  }
  for (const std::uint32_t row : rest) {
    for (std::size_t a = 0; a < 3; ++a) {
      extent = std::max(extent, static_cast<double>(points[row][a]) - static_cast<double>(low[a]));
    }
  }
  double radius = extent / kFirstLevel;
  for (int level = 0; level < kLevels && radius > 0.0 && order.size() < most; ++level) {
    // Once half of the points are in, their order is as good as any: they are shown together.
    if (2 * order.size() >= most && rest.size() + order.size() == most) break;
    Grid grid(points, low, radius, std::min(most, rest.size()));
    for (const std::uint32_t row : order) grid.add(row);
    std::size_t kept = 0;
    for (const std::uint32_t row : rest) {
      if (order.size() < most && grid.isFree(row)) {
        grid.add(row);
        order.push_back(row);
      } else {
        rest[kept++] = row;
      }
    }
    rest.resize(kept);
    radius *= 0.5;
  }
  const std::size_t missing = std::min(most - order.size(), rest.size());
  order.insert(order.end(), rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(missing));
  return order;
}

std::vector<std::size_t> sortLevels(const PointView& points, std::vector<std::uint32_t>& order,
                                    int threads) {
  std::vector<std::size_t> ends;
  std::size_t begin = 0;
  while (begin < order.size()) {
    const std::size_t end = std::min(order.size(), begin + std::max(kFirstPoints, begin / 4));
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    sortInSpace(points, at(begin), at(end), threads);
    ends.push_back(end);
    begin = end;
  }
  return ends;
}

}  // namespace segorient::program
