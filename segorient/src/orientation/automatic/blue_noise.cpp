// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/blue_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/parallel_for.h"

namespace segorient::detail {
namespace {

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

// Kept points by cubes as wide as the radius: what is nearer lies in the 27 around.
class KeptPoints {
 public:
  KeptPoints(const PointView& points, float radius) : points_(points) {
    for (std::size_t i = 0; i < points.size; ++i) {
      for (std::size_t a = 0; a < 3; ++a) low_[a] = std::min(low_[a], points[i][a]);
    }
    per_cube_ = 1.0 / static_cast<double>(radius);
    std::size_t slots = 16;
    while (slots < 2 * points.size) slots *= 2;
    first_.assign(slots, kNobody);
    mask_ = slots - 1;
  }

  // Whether a kept one is nearer than sqrt(limit).
  bool hasNear(const float* p, float limit, const std::vector<std::uint32_t>& kept) const {
    return forEachAround(p, kept, [&](std::uint32_t, float squares) { return squares < limit; });
  }

  // \return the nearest kept one's number if it is nearer than sqrt(limit)
  std::uint32_t nearest(const float* p, float limit, const std::vector<std::uint32_t>& kept) const {
    std::uint32_t best = kNobody;
    forEachAround(p, kept, [&](std::uint32_t k, float squares) {
      // Of equally near ones the first: some slots are looked at more than once.
      if (squares < limit || (squares == limit && best != kNobody && k < best)) {
        limit = squares;
        best = k;
      }
      return false;
    });
    return best;
  }

  void add(const float* p) {
    const auto k = static_cast<std::uint32_t>(next_.size());
    const Cube at = cubeOf(p);
    std::uint32_t& first = first_[slotOf(columnOf(at[0], at[1]), at[2])];
    next_.push_back(first);
    first = k;
  }

 private:
  using Cube = std::array<std::int64_t, 3>;

  Cube cubeOf(const float* p) const {
    Cube cube{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = static_cast<double>(p[a]) - static_cast<double>(low_[a]);
      cube[a] = static_cast<std::int64_t>(std::floor(d * per_cube_));
    }
    return cube;
  }
  // The cubes of a column are side by side.
  static std::uint64_t columnOf(std::int64_t x, std::int64_t y) {
    std::uint64_t h = 0;
    for (const std::int64_t c : {x, y}) {
      h = (h ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15ULL;
      h ^= h >> 29U;
    }
    return h;
  }
  // Cubes may share a slot: distances tell.
  std::size_t slotOf(std::uint64_t column, std::int64_t z) const {
    return static_cast<std::size_t>(column + static_cast<std::uint64_t>(z)) & mask_;
  }

  // Calls act(k, square of the distance) for what is kept in the cubes around a point, its own
  // column first. \return whether act said so of one, which then is the last
  template <typename Act>
  bool forEachAround(const float* p, const std::vector<std::uint32_t>& kept, const Act& act) const {
    const Cube at = cubeOf(p);
    for (const std::int64_t x : {at[0], at[0] - 1, at[0] + 1}) {
      for (const std::int64_t y : {at[1], at[1] - 1, at[1] + 1}) {
        const std::uint64_t column = columnOf(x, y);
        for (std::int64_t z = at[2] - 1; z <= at[2] + 1; ++z) {
          for (std::uint32_t k = first_[slotOf(column, z)]; k != kNobody; k = next_[k]) {
            const float* q = points_[kept[k]];
            float squares = 0.F;
            for (std::size_t a = 0; a < 3; ++a) squares += (p[a] - q[a]) * (p[a] - q[a]);
            if (act(k, squares)) return true;
          }
        }
      }
    }
    return false;
  }

  PointView points_;
  std::array<float, 3> low_{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                            std::numeric_limits<float>::max()};
  double per_cube_ = 1.0;
  std::vector<std::uint32_t> first_;  // of each slot
  std::vector<std::uint32_t> next_;   // of each kept point, in its slot
  std::size_t mask_ = 0;
};

}  // namespace

BlueNoise thinOut(const PointView& points, float radius, int threads) {
  BlueNoise out;
  constexpr float kLeast = 1e-12F;  // its square and the numbers of cubes are ordinary ones
  if (!(radius > kLeast)) return out;
  const float limit = radius * radius;
  KeptPoints near(points, radius);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (near.hasNear(points[i], limit, out.kept)) continue;
    near.add(points[i]);
    out.kept.push_back(static_cast<std::uint32_t>(i));
  }
  out.cell_of.resize(points.size);
  parallelFor(points.size, threads, 150.0, [&](std::size_t i) {
    // A kept point finds itself; of the others each has one nearer than the radius.
    out.cell_of[i] = near.nearest(points[i], limit, out.kept);
  });
  return out;
}

std::vector<float> meanPlaces(const PointView& points, const BlueNoise& cells) {
  std::vector<float> places(4 * cells.kept.size(), 0.F);
  std::vector<float> counts(cells.kept.size(), 0.F);
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::size_t c = cells.cell_of[i];
    for (std::size_t a = 0; a < 3; ++a) places[4 * c + a] += points[i][a];
    counts[c] += 1.F;
  }
  for (std::size_t c = 0; c < counts.size(); ++c) {
    for (std::size_t a = 0; a < 3; ++a) places[4 * c + a] /= counts[c];
  }
  return places;
}

}  // namespace segorient::detail
