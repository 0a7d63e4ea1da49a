// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "common/in_double.h"
#include "common/parts.h"

namespace segorient {

/// Where points are, axis by axis.
struct Bounds {
  std::array<double, 3> low;
  std::array<double, 3> high;
  std::size_t points = 0;  ///< finite ones

  Bounds() {
    low.fill(std::numeric_limits<double>::max());
    high.fill(std::numeric_limits<double>::lowest());
  }
  void add(const std::array<double, 3>& p) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
    ++points;
  }
  void add(const Bounds& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
    points += other.points;
  }
  bool contains(const std::array<double, 3>& p) const {
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) inside = inside && p[a] >= low[a] && p[a] <= high[a];
    return inside;
  }
  /// The longest side.
  double extent() const {
    double longest = 0.0;
    for (std::size_t a = 0; a < 3 && points > 0; ++a) longest = std::max(longest, high[a] - low[a]);
    return longest;
  }
  /// The largest absolute coordinate.
  double reach() const {
    double most = 0.0;
    for (std::size_t a = 0; a < 3 && points > 0; ++a) {
      most = std::max({most, std::abs(low[a]), std::abs(high[a])});
    }
    return most;
  }
  std::array<double, 3> middle() const {
    std::array<double, 3> m{0.0, 0.0, 0.0};
    for (std::size_t a = 0; a < 3 && points > 0; ++a) m[a] = low[a] + 0.5 * (high[a] - low[a]);
    return m;
  }
  /// Floats resolve 1e-7 of the extent only near the origin: whether these points are farther away
  /// than twice their extent, as map coordinates are.
  bool isFar() const { return reach() > 2.0 * extent(); }
  /// Whether a point is farther away than floats reach: to one that holds the difference, all of
  /// these are one place. Such a point is nobody's neighbour.
  bool isBeyondFloats(const std::array<double, 3>& p) const {
    constexpr double kFloatSteps = 16777216.0;  // 2^24
    const double most = kFloatSteps * extent();
    bool beyond = points == 0;
    for (std::size_t a = 0; a < 3; ++a) {
      beyond = beyond || !(p[a] >= low[a] - most && p[a] <= high[a] + most);
    }
    return beyond;
  }
};

/// The box that no point of the bulk is outside of: 16 times the range between the quartiles around
/// the median, the same for all axes. Up to a quarter of the points may be strays, at 0,0,0 or
/// anywhere. Surfaces, scans that thin out towards the horizon and the like are within.
/// \param coordinates finite ones by axis; used up
/// \return everything where half of the points are in one place
SEGORIENT_SEARCH_EXPORT Bounds fenceAround(std::array<std::vector<double>, 3>& coordinates);

/// Bounds of all finite points but strays.
/// \param position of each of `size` points, an array of three
/// \param threads see resolveThreads()
template <typename Position>
Bounds bulkBounds(std::size_t size, const Position& position, int threads = 1) {
  constexpr double kPointTime = 10.0;  // nanoseconds
  const Parts parts(size, threads, kPointTime);
  const auto isFinitePoint = [](const std::array<double, 3>& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  };
  std::vector<Bounds> bounds(parts.count());
  parts.forEach([&](std::size_t part) {
    Bounds own;
    for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
      const std::array<double, 3> p = position(i);
      if (isFinitePoint(p)) own.add(p);
    }
    bounds[part] = own;
  });
  Bounds all;
  for (const Bounds& own : bounds) all.add(own);
  if (all.points == 0) return all;
  // Strays matter only if they are farther away than the bulk is wide: then all of that is in a few
  // of these slots along the longest side. The others may be no longer than without strays.
  constexpr std::size_t kSlots = 64;
  std::size_t a = 0;
  for (std::size_t b = 1; b < 3; ++b) {
    if (all.high[b] / 2.0 - all.low[b] / 2.0 > all.high[a] / 2.0 - all.low[a] / 2.0) a = b;
  }
  // Halves, since the extent itself may overflow.
  const double range = all.high[a] / 2.0 - all.low[a] / 2.0;
  using Slots = std::array<std::size_t, kSlots>;
  std::vector<Slots> slots_of(parts.count());
  parts.forEach([&](std::size_t part) {
    Slots own{};
    for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
      const std::array<double, 3> p = position(i);
      if (!isFinitePoint(p)) continue;
      const double at = range > 0.0 ? (p[a] / 2.0 - all.low[a] / 2.0) / range : 0.0;
      ++own[static_cast<std::size_t>(std::min(at * kSlots, kSlots - 1.0))];
    }
    slots_of[part] = own;
  });
  Slots slots{};
  for (const Slots& own : slots_of) {
    for (std::size_t s = 0; s < kSlots; ++s) slots[s] += own[s];
  }
  std::size_t fullest = 0;
  for (std::size_t s = 0; s + 1 < kSlots; ++s) fullest = std::max(fullest, slots[s] + slots[s + 1]);
  if (2 * fullest < all.points) return all;
  std::array<std::vector<double>, 3> coordinates;
  for (auto& axis : coordinates) axis.reserve(all.points);
  for (std::size_t i = 0; i < size; ++i) {
    const std::array<double, 3> p = position(i);
    for (std::size_t b = 0; b < 3 && isFinitePoint(p); ++b) coordinates[b].push_back(p[b]);
  }
  const Bounds fence = fenceAround(coordinates);
  Bounds bulk;
  for (std::size_t i = 0; i < size; ++i) {
    const std::array<double, 3> p = position(i);
    if (isFinitePoint(p) && fence.contains(p)) bulk.add(p);
  }
  // So many are none: half of a depth image may be at 0,0,0 where the camera saw nothing.
  const bool astray = 4 * (all.points - bulk.points) <= all.points;
  return astray ? bulk : all;
}

inline Bounds bulkBounds(const PointView& points, int threads = 1) {
  return bulkBounds(
      points.size, [&](std::size_t i) { return inDouble(points[i]); }, threads);
}

}  // namespace segorient
