// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/splats.h"

#include <segorient/common/threads.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>

#include "render/page/disc_radii.h"

namespace segorient::program {
namespace {

// Of so many, those across an edge end the disc: nearly all discs that reach an edge have one.
constexpr int kAround = 16;
constexpr float kEdgeCosine = 0.82F;  // normals 35 degrees apart: an edge
// The neighbours that turn least tell how the surface turns: along the edge of a face they are
// those of the face, of a point on the edge itself, whose normal is between two faces', they are
// not.
constexpr std::size_t kAlike = 3;

using Vec = std::array<float, 3>;

float dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// What the neighbours of a splat tell of the surface around. Signs of normals play no part.
void lookAround(const std::vector<Splat>& splats, const std::vector<std::int32_t>& splat_of,
                const pcl::index_t* neighbors, int count, Splat& s) {
  std::array<float, kCover> cosines{};
  std::array<float, kCover> heights{};
  std::size_t seen = 0;
  std::size_t same = 0;
  for (int j = 1; j < count; ++j) {
    const std::int32_t other = splat_of[static_cast<std::size_t>(neighbors[j])];
    if (other < 0) continue;
    const Splat& o = splats[static_cast<std::size_t>(other)];
    const float cosine = std::abs(dot(s.normal, o.normal));
    if (!std::isfinite(cosine)) continue;
    if (j <= kCover) cosines[seen++] = cosine;
    if (cosine < kEdgeCosine) {
      // A neighbour's plane ends the splat: that is where the edge between the two runs.
      if (s.cuts < Splat::kMostCutters) s.cutters[s.cuts++] = static_cast<std::uint32_t>(other);
    } else if (j <= kCover) {
      // On a round surface the planes of both lie as far off the other point, in opposite
      // directions.
      const Vec d{o.position[0] - s.position[0], o.position[1] - s.position[1],
                  o.position[2] - s.position[2]};
      const float sign = dot(s.normal, o.normal) < 0.F ? -1.F : 1.F;
      heights[same++] = 0.5F * std::abs(dot(s.normal, d) + sign * dot(o.normal, d));
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

void setSides(const PointView& points, const Neighborhoods& neighborhoods,
              const std::vector<float>& radii, float middle, int threads,
              const std::vector<std::size_t>& rows, std::vector<Splat>& splats) {
  std::vector<float> normals(3 * points.size, NAN);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy_n(splats[i].normal.begin(), 3, &normals[3 * rows[i]]);
  }
  const std::vector<Side> sides = findSides(points, normals, neighborhoods, radii, middle, threads);
  for (std::size_t i = 0; i < rows.size(); ++i) splats[i].side = sides[rows[i]];
}

}  // namespace

std::array<float, 3> NormalSource::at(std::size_t row) const {
  if (!any()) return {NAN, NAN, NAN};
  std::array<double, 3> n{};
  if (normals_ == nullptr) {
    n = table_.triple(columns_, row);
  } else {
    std::copy_n(normals_ + 4 * row, 3, n.begin());
  }
  const double length = std::hypot(n[0], n[1], n[2]);
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

std::vector<Splat> makeSplats(const PointView& points, const NormalSource& normals, int threads,
                              std::vector<std::size_t>& rows) {
  search::MedianHashIndex index;
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index.build(points, nullptr, options);
  Neighborhoods neighborhoods;
  index.nearestKAll(kAround + 1, neighborhoods);

  float middle = 0.F;
  const std::vector<float> radii = discRadii(neighborhoods, middle);
  std::vector<std::int32_t> splat_of(points.size, -1);
  rows.clear();
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isFinite(points[i])) continue;
    splat_of[i] = static_cast<std::int32_t>(rows.size());
    rows.push_back(i);
  }
  std::vector<Splat> splats(rows.size());
  const auto count = static_cast<std::ptrdiff_t>(rows.size());
  const int workers = resolveThreads(threads);
#pragma omp parallel for num_threads(workers)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::size_t row = rows[static_cast<std::size_t>(i)];
    Splat& s = splats[static_cast<std::size_t>(i)];
    s.position = {points[row][0], points[row][1], points[row][2]};
    s.normal = normals.at(row);
    s.radius = radii[row];
  }
  if (!normals.any()) return splats;
  setSides(points, neighborhoods, radii, middle, threads, rows, splats);
#pragma omp parallel for schedule(static, 4096) num_threads(workers)
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::size_t row = rows[static_cast<std::size_t>(i)];
    lookAround(splats, splat_of, neighborhoods.indices(row), neighborhoods.count(row),
               splats[static_cast<std::size_t>(i)]);
  }
  return splats;
}

}  // namespace segorient::program
