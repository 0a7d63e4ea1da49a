// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/splats.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/threads.h"
#include "render/page/disc_radii.h"
#include "render/page/space_order.h"
#include "render/page/vectors.h"

namespace segorient::program {
namespace {

// Of so many, those across an edge end the disc: nearly all discs that reach an edge have one.
constexpr int kAround = 16;
// With so many, discs are about as large as pixels, and where they end is not seen: those around
// that the disc covers will do.
constexpr std::size_t kMany = 2'000'000;
// The neighbours that turn least tell how the surface turns: along the edge of a face they are
// those of the face, of a point on the edge itself, whose normal is between two faces', they are
// not.
constexpr std::size_t kAlike = 3;

// What the neighbours of a splat tell of the surface around. Signs of normals play no part. Packed
// positions and normals: those of all neighbours come from memory.
void lookAround(const std::vector<float>& positions, const std::vector<float>& normals,
                const pcl::index_t* neighbors, int count, Splat& s) {
  std::array<float, kCover> cosines{};
  std::array<float, kCover> heights{};
  std::size_t seen = 0;
  std::size_t same = 0;
  for (int j = 1; j < count; ++j) {
    const auto other = static_cast<std::size_t>(neighbors[j]);
    const Vec normal = vectorAt(&normals[3 * other]);
    const float cosine = std::abs(dot(s.normal, normal));
    if (!std::isfinite(cosine)) continue;
    if (j <= kCover) cosines[seen++] = cosine;
    if (cosine < kSameSheet) {
      // A neighbour's plane ends the splat: that is where the edge between the two runs.
      if (s.cuts < Splat::kMostCutters) s.cutters[s.cuts++] = static_cast<std::uint32_t>(other);
    } else if (j <= kCover) {
      // On a round surface the planes of both lie as far off the other point, in opposite
      // directions.
      const float* to = &positions[3 * other];
      const Vec d{to[0] - s.position[0], to[1] - s.position[1], to[2] - s.position[2]};
      const float sign = dot(s.normal, normal) < 0.F ? -1.F : 1.F;
      heights[same++] = 0.5F * std::abs(dot(s.normal, d) + sign * dot(normal, d));
    }
  }
  if (same > 0) {
    const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(same / 2);
    std::nth_element(heights.begin(), middle, heights.begin() + static_cast<std::ptrdiff_t>(same));
    s.noise = std::isfinite(*middle) ? *middle : 0.F;
  }
  if (seen == 0) return;
  const std::size_t rank = std::min(kAlike, seen) - 1;
  const auto at = cosines.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(cosines.begin(), at, cosines.begin() + static_cast<std::ptrdiff_t>(seen),
                   std::greater<>());
  s.turn = std::sqrt(std::max(0.F, 0.5F * (1.F - *at)));  // half way, where the discs meet
}

// Rows of finite points in an order in which neighbours are near each other: all that follows looks
// from points to those around, and a large cloud in random order does not fit into caches.
std::vector<std::uint32_t> orderedRows(const PointView& points, int threads) {
  std::vector<std::uint32_t> rows;
  rows.reserve(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (isFinite(points[i])) rows.push_back(static_cast<std::uint32_t>(i));
  }
  sortInSpace(points, rows.begin(), rows.end(), threads);
  return rows;
}

}  // namespace

std::array<float, 3> NormalSource::at(std::size_t row) const {
  if (!any_) return {NAN, NAN, NAN};
  std::array<double, 3> n{};
  if (normals_ == nullptr) {
    n = table_.triple(columns_, row);
  } else {
    std::copy_n(normals_ + 4 * row, 3, n.begin());
  }
  double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!std::isnormal(length)) length = std::hypot(n[0], n[1], n[2]);  // slow, but of any numbers
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

std::vector<Splat> makeSplats(const PointView& all, const NormalSource& normals, int threads,
                              std::vector<std::uint32_t>& rows) {
  rows = orderedRows(all, threads);
  const auto count = static_cast<std::ptrdiff_t>(rows.size());
  const int workers = resolveThreads(threads);
  std::vector<Splat> splats(rows.size());
  std::vector<float> near(3 * rows.size());
  std::vector<float> directions(normals.any() ? near.size() : 0);
  // All that is read from the rows at once: the memory of a large cloud is far away.
#pragma omp parallel for schedule(static, 4096) num_threads(workers)
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    splats[i].position = vectorAt(all[rows[i]]);
    splats[i].normal = normals.at(rows[i]);
    std::copy_n(all[rows[i]], 3, &near[3 * i]);
    if (!directions.empty()) std::copy_n(splats[i].normal.begin(), 3, &directions[3 * i]);
  }
  PointView points;
  points.data = near.data();
  points.stride = 3;
  points.size = rows.size();
  search::MedianHashIndex index;
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index.build(points, nullptr, options);
  Neighborhoods neighborhoods;
  index.nearestKAll((rows.size() > kMany ? kCover : kAround) + 1, neighborhoods);

  float middle = 0.F;
  const std::vector<float> radii = discRadii(neighborhoods, middle, threads);
  std::vector<Side> sides(rows.size(), Side::Open);
  if (normals.any()) sides = findSides(points, directions, neighborhoods, radii, middle, threads);
#pragma omp parallel for schedule(static, 4096) num_threads(workers)
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    splats[i].radius = radii[i];
    splats[i].side = sides[i];
    if (normals.any()) {
      lookAround(near, directions, neighborhoods.indices(i), neighborhoods.count(i), splats[i]);
    }
  }
  return splats;
}

}  // namespace segorient::program
