// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/spread_planes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "common/parallel_for.h"
#include "features/grown_planes.h"
#include "features/more_neighbors.h"
#include "features/sheet_fit.h"
#include "features/surface_sizes.h"

namespace segorient::detail {
namespace {

// Half as many again each time, up to where planes are nearly free of noise.
constexpr std::array<int, 5> kSizes{12, 18, 27, 40, MoreNeighbors::kMost};
// Of the variances across a plane and along its shorter side: 30 points on two faces of an edge
// have .1 and more.
constexpr float kFlat = 0.05F;
// ns a point, see resolveThreads().
constexpr double kQueryTime = 4000.0;

bool isSpread(const Plane& plane) {
  return plane.valid && plane.lambda[1] >= kOneLine * plane.lambda[2];
}

// Moments of the first points of a row, added as more are asked for.
class GrowingMoments {
 public:
  GrowingMoments(const PointView& points, const float* middle, const pcl::index_t* row, int count)
      : points_(points), middle_(middle), row_(row), count_(count) {
    const float* farthest = points_[static_cast<std::size_t>(row_[count_ - 1])];
    double square = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = static_cast<double>(farthest[a]) - static_cast<double>(middle_[a]);
      square += d * d;
    }
    const double radius = std::sqrt(square);
    per_length_ = radius > 0.0 ? static_cast<float>(1.0 / radius) : 0.F;
  }

  Plane planeOf(int entries) {
    for (; added_ < std::min(entries, count_); ++added_) {
      const float* q = points_[static_cast<std::size_t>(row_[added_])];
      moments_.add((q[0] - middle_[0]) * per_length_, (q[1] - middle_[1]) * per_length_,
                   (q[2] - middle_[2]) * per_length_);
    }
    return added_ < 3 ? Plane{} : fitPlane(moments_);
  }

 private:
  const PointView& points_;
  const float* middle_;
  const pcl::index_t* row_;
  int count_;
  int added_ = 0;
  float per_length_ = 0.F;
  Moments moments_;
};

}  // namespace

bool spreads(const Surroundings& of, std::size_t row, int k) {
  const int count = std::min(of.table.count(row), k + 1);
  if (count < 1) return false;
  return isSpread(
      GrowingMoments(of.points, of.at[row], of.table.indices(row), count).planeOf(count));
}

bool seesLines(const Surroundings& of) {
  // Three times what chance does: of one in sixty of points at random they are on a line.
  constexpr double kMany = 0.05;
  const std::vector<pcl::index_t> rows = sampleRows(of.table.size());
  const auto of_one_line = std::count_if(rows.begin(), rows.end(), [&](pcl::index_t r) {
    return !spreads(of, static_cast<std::size_t>(r), kTriangulationNeighbors);
  });
  return static_cast<double>(of_one_line) > kMany * static_cast<double>(rows.size());
}

std::size_t takeSpreadPlanes(const Surroundings& of, const search::MedianHashIndex* index,
                             const std::vector<pcl::index_t>& rows, int threads, float* normals) {
  std::atomic<std::size_t> taken{0};
  parallelFor(rows.size(), threads, kQueryTime, [&](std::size_t r) {
    const auto row = static_cast<std::size_t>(rows[r]);
    std::array<pcl::index_t, MoreNeighbors::kMost + 1> more;
    std::array<float, MoreNeighbors::kMost + 1> squares;
    const pcl::index_t* nearest = of.table.indices(row);
    int count = of.table.count(row);
    if (index != nullptr && count < static_cast<int>(more.size())) {
      count = index->nearestK(of.at[row], static_cast<int>(more.size()), more.data(),
                              squares.data(), 0.F);
      nearest = more.data();
    }
    if (count < 3) return;
    GrowingMoments moments(of.points, of.at[row], nearest, count);
    Plane plane;
    for (const int k : kSizes) {
      plane = moments.planeOf(k + 1);
      if (isSpread(plane) || k + 1 >= count) break;
    }
    if (!isSpread(plane) || plane.lambda[0] > kFlat * plane.lambda[1]) return;
    float* n = normals + 4 * row;
    std::copy_n(plane.normal.data(), 3, n);
    n[3] = plane.variation();
    taken.fetch_add(1, std::memory_order_relaxed);
  });
  return taken;
}

}  // namespace segorient::detail
