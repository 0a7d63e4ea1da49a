// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/threads.h"
#include "render/page/depth_maps.h"

namespace segorient::program {
namespace {

// Points that ask from one direction. Larger clouds take turns: neighbours ask from the others.
constexpr std::size_t kMostAsked = 500'000;
constexpr std::size_t kMostDrawn = 1'250'000;  // five a pixel, as near and as far sides

constexpr float kNoise = 2.F;       // standard deviations
constexpr float kUneven = 2.F;      // times the middle noise
constexpr float kQuartile = 0.32F;  // of them, one in four is smaller than so many
constexpr float kLevel = 0.5F;      // sine of 30 degrees: neighbours lie along the plane
constexpr float kFlat = 0.1F;       // sine of 6 degrees: they lie in it
// Fewer neighbours are no surface that would tell that a point is wrong.
constexpr int kSurface = 4;
// Seen from one side so many times as often as from the other: that one is outside. More, and the
// other is closed: where a surface ends in a sharp edge, one in some ten looks past it.
constexpr int kOuter = 3;
constexpr int kClosed = 6;
// A point has sixteen sights from each side at most. Less than one of them is what gaps between
// points let through to the walls of cavities, and those of two points are no evidence at all.
constexpr int kLeastSights = 1;
constexpr int kFewest = 32;
// Of the neighbours, so many in four that point the other way contradict a point.
constexpr int kContradict = 3;

std::uint32_t turnOf(const float* p) {
  std::uint64_t hash = 0;
  for (int a = 0; a < 3; ++a) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, p + a, sizeof(bits));
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29;
  }
  return static_cast<std::uint32_t>(hash >> 32);
}

class Counting {
 public:
  Counting(const PointView& points, const std::vector<float>& normals,
           const Neighborhoods& neighborhoods, const std::vector<float>& radii, float middle,
           int threads)
      : points_(points),
        normals_(normals),
        neighborhoods_(neighborhoods),
        threads_(resolveThreads(threads)) {
    fill(radii, middle);
    front_.assign(rows_.size(), 0);
    back_.assign(rows_.size(), 0);
#pragma omp parallel for schedule(dynamic, 1) num_threads(std::min(threads_, kAxes))
    for (int axis = 0; axis < kAxes; ++axis) {
      DepthMaps(sample_, axis).count(front_, back_);
    }
  }

  std::vector<Side> judge() const {
    std::vector<Side> sides(points_.size, Side::Open);
    std::vector<Sights> around(rows_.size());
    const auto own = [&](std::size_t i) { return Sights{front_[i], back_[i], 1}; };
    const auto count = static_cast<std::ptrdiff_t>(rows_.size());
#pragma omp parallel for schedule(static, 4096) num_threads(threads_)
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      around[i] = sumAround(i, own).sights;
    }
#pragma omp parallel for schedule(static, 4096) num_threads(threads_)
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      sides[rows_[i]] = judgeOne(i, around);
    }
    return sides;
  }

 private:
  Vec normal(std::size_t row) const {
    return {normals_[3 * row], normals_[3 * row + 1], normals_[3 * row + 2]};
  }
  Vec between(std::size_t from, std::size_t to) const {
    const float* p = points_[from];
    const float* q = points_[to];
    return {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  }
  // How far the points around lie off a point's plane. A quarter lies less far off than so; half of
  // them may belong to the other side of a thin wall.
  float noiseOf(std::size_t row) const {
    std::array<float, 8> heights{};
    std::size_t seen = 0;
    const int count = std::min(neighborhoods_.count(row), static_cast<int>(heights.size()) + 1);
    for (int j = 1; j < count; ++j) {
      const auto other = static_cast<std::size_t>(neighborhoods_.indices(row)[j]);
      const float height = std::abs(dot(normal(row), between(row, other)));
      if (std::isfinite(height)) heights[seen++] = height;
    }
    if (seen == 0) return 0.F;
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(seen / 4);
    std::nth_element(heights.begin(), low, heights.begin() + static_cast<std::ptrdiff_t>(seen));
    return *low / kQuartile;
  }
  void fill(const std::vector<float>& radii, float middle) {
    place_.assign(points_.size, kNone);
    rows_.reserve(points_.size);
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < points_.size; ++i) {
      // Far apart as floats can be: their squares overflow, and nothing lies before anything.
      if (!isFinite(points_[i]) || !(radii[i] > 0.F)) continue;
      place_[i] = static_cast<std::uint32_t>(rows_.size());
      rows_.push_back(static_cast<std::uint32_t>(i));
      for (std::size_t a = 0; a < 3; ++a) sum[a] += static_cast<double>(points_[i][a]);
    }
    sample_.middle = middle;
    sample_.points.resize(rows_.size());
    sample_.normals.resize(rows_.size());
    sample_.radii.resize(rows_.size());
    sample_.noise.resize(rows_.size());
    std::vector<std::uint32_t> turns(rows_.size());
    const auto count = static_cast<std::ptrdiff_t>(rows_.size());
    for (double& s : sum) s /= static_cast<double>(count);
#pragma omp parallel for schedule(static, 4096) num_threads(threads_)
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const std::size_t row = rows_[i];
      for (std::size_t a = 0; a < 3; ++a) {
        sample_.points[i][a] = static_cast<float>(static_cast<double>(points_[row][a]) - sum[a]);
      }
      sample_.normals[i] = normal(row);
      sample_.radii[i] = radii[row];
      sample_.noise[i] = kNoise * noiseOf(row);
      turns[i] = turnOf(points_[row]);
    }
    limitNoise();
    sample_.drawn = shared(turns, kMostDrawn);
    sample_.asking = shared(turns, kMostAsked);
  }
  // The points in as many shares as it takes for none to be larger than so.
  static std::vector<std::vector<std::uint32_t>> shared(const std::vector<std::uint32_t>& turns,
                                                        std::size_t most) {
    std::vector<std::vector<std::uint32_t>> shares(turns.size() / most + 1);
    const auto count = static_cast<std::uint32_t>(shares.size());
    for (auto& share : shares) share.reserve(turns.size() / count);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      shares[turns[i] % count].push_back(static_cast<std::uint32_t>(i));
    }
    return shares;
  }
  // Noise is much the same everywhere; where more shows, it is another surface close by.
  void limitNoise() {
    if (rows_.empty()) return;
    std::vector<float> sorted = sample_.noise;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      sample_.noise[i] = std::min({sample_.noise[i], kUneven * *middle, kNoise * sample_.radii[i]});
    }
  }
  // Sights of a point, or sums of them over its surroundings.
  struct Sights {
    int front = 0;
    int back = 0;
    int points = 0;
  };
  // What follows for a point from those of the same surface around.
  struct Sum {
    Sights sights;
    int alike = 0;  // neighbours whose normals point the same way, and the other
    int contrary = 0;
    int beyond = 0;  // neighbours across an edge
    // Enough of a surface to tell that a point is wrong. One with which no other agrees is not
    // outvoted by fewer than lie beyond the edge beside it: it may be all that there is of a face.
    bool isSurface() const {
      return alike + contrary >= kSurface && (alike > 0 || contrary > beyond);
    }
  };
  template <typename Get>
  Sum sumAround(std::size_t i, const Get& get) const {
    const std::size_t row = rows_[i];
    const Vec n = normal(row);
    Sum sum;
    sum.sights = get(i);
    for (int j = 1; j < neighborhoods_.count(row); ++j) {
      const auto other = static_cast<std::size_t>(neighborhoods_.indices(row)[j]);
      const std::uint32_t place = place_[other];
      if (place == kNone) continue;
      const Vec m = normal(other);
      const float cosine = dot(n, m);
      if (std::abs(cosine) < kSameSheet) ++sum.beyond;
      if (!(std::abs(cosine) >= kSameSheet)) continue;
      const Vec d = between(row, other);
      const float distance = std::sqrt(dot(d, d));
      const float level = kLevel * distance + sample_.noise[i];
      if (std::abs(dot(n, d)) > level || std::abs(dot(m, d)) > level) continue;
      const bool same = cosine > 0.F;
      // Of one surface, however it bends, the planes of both lie as far off the other point, in
      // opposite directions. Those of two sides of a thin wall do not.
      if (!same && std::abs(dot(n, d) - dot(m, d)) > 2.F * kFlat * distance) continue;
      const Sights theirs = get(place);
      ++(same ? sum.alike : sum.contrary);
      sum.sights.front += same ? theirs.front : theirs.back;
      sum.sights.back += same ? theirs.back : theirs.front;
      sum.sights.points += theirs.points;
    }
    return sum;
  }
  Side judgeOne(std::size_t i, const std::vector<Sights>& around) const {
    if (!std::isfinite(normals_[3 * std::size_t{rows_[i]}])) return Side::Open;
    const Sum sum = sumAround(i, [&](std::size_t at) { return around[at]; });
    const auto [front, back, points] = sum.sights;
    const int more = std::max(front, back);
    const auto shares = static_cast<int>(sample_.asking.size());
    const int less = std::min(front, back);
    if (more >= kFewest && more * shares >= kLeastSights * points && more >= kOuter * less) {
      const bool closed = more >= kClosed * less;
      if (back > front && !sum.isSurface()) return Side::Open;
      if (back > front) return closed ? Side::Wrong : Side::Contrary;
      return closed ? Side::Right : Side::Outer;
    }
    const bool contradicted = sum.isSurface() && sum.contrary > kContradict * sum.alike;
    return contradicted ? Side::Contrary : Side::Open;
  }

  const PointView& points_;
  const std::vector<float>& normals_;
  const Neighborhoods& neighborhoods_;
  int threads_;
  std::vector<std::uint32_t> rows_;   // of the sample
  std::vector<std::uint32_t> place_;  // in the sample, by row
  Sample sample_;
  std::vector<std::uint8_t> front_;
  std::vector<std::uint8_t> back_;
};

}  // namespace

std::vector<Side> findSides(const PointView& points, const std::vector<float>& normals,
                            const Neighborhoods& neighborhoods, const std::vector<float>& radii,
                            float middle, int threads) {
  return Counting(points, normals, neighborhoods, radii, middle, threads).judge();
}

}  // namespace segorient::program
