// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Walls that many points look for at once, and planes that are compared side by side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "feature_clouds.h"
#include "features/sheet_walls.h"

namespace segorient::test {
namespace {

using detail::kWallEntries;
using detail::Offsets;
using detail::Plane;
using detail::WallRows;

const char* const kSets[] = {"scalar", "sse2", "avx2", "avx512"};

/// Two walls, apart by a distance that grows along x from 0 to four mean distances between points,
/// with noise that grows along y.
Sample wedge() {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::normal_distribution<float> gauss;
  Sample sample;
  constexpr int kCount = 6000;
  const float spacing = std::sqrt(2.F / kCount);
  for (int i = 0; i < kCount; ++i) {
    const float x = unit(random);
    const float y = unit(random);
    const float z = (i % 2 == 0 ? 4.F * x : 0.F) + 0.3F * y * gauss(random);
    sample.add({x, y, z * spacing}, {0.F, 0.F, 1.F});
  }
  return sample;
}

TEST(SheetWalls, OfManyPointsAreThoseOfEach) {
  const Sample sample = wedge();
  const PointView points = sample.view();
  const Neighborhoods table = neighborsOf(points, kSheetNeighbors + 1);
  std::mt19937 random(6);
  std::normal_distribution<float> gauss;
  for (const float most_apart : {detail::kWallsApart, detail::kThinWallsApart}) {
    std::size_t found = 0;
    for (std::size_t first = 0; first + WallRows::kRows <= points.size; first += WallRows::kRows) {
      WallRows rows{};
      rows.xyz = points.data;
      rows.most_apart = most_apart;
      std::uint32_t expected = 0;
      for (std::size_t l = 0; l < WallRows::kRows; ++l) {
        const std::size_t i = first + l;
        ASSERT_GE(table.count(i), static_cast<int>(kWallEntries));
        const float spacing = detail::meanDistance(points, table, i, detail::kFirstRing);
        const Eigen::Vector3f normal =
            Eigen::Vector3f(0.1F * gauss(random), 0.1F * gauss(random), 1.F).normalized();
        const Offsets offsets = detail::gatherOffsets(points, table, i, spacing);
        expected |= (detail::splitWalls(offsets, normal, most_apart).found ? 1U : 0U) << l;
        rows.own[l] = points[i];
        rows.rows[l] = table.indices(i);
        rows.normal_x[l] = normal.x();
        rows.normal_y[l] = normal.y();
        rows.normal_z[l] = normal.z();
        rows.per_spacing[l] = 1.F / spacing;
        found += expected >> l & 1U;
      }
      for (const char* set : kSets) {
        setenv("SEGORIENT_SIMD", set, 1);
        EXPECT_EQ(detail::seesTwoWalls(rows), expected) << set << ", from " << first;
        unsetenv("SEGORIENT_SIMD");
      }
    }
    // Or neither answer was tried.
    EXPECT_GT(found, points.size / 20);
    EXPECT_LT(found, points.size / 2);
  }
}

TEST(DominantPlane, IsOfOneFaceAndTheSameForAnyInstructionSet) {
  const Sample sample = cube(6000, 7);
  const PointView points = sample.view();
  const Neighborhoods table = neighborsOf(points, kSheetNeighbors + 1);
  std::size_t at_edges = 0;
  std::size_t right = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float spacing = detail::meanDistance(points, table, i, detail::kFirstRing);
    const Offsets offsets = detail::gatherOffsets(points, table, i, spacing);
    const Plane start = detail::fitPlane(detail::momentsOf(offsets, kSheetNeighbors));
    if (!start.valid || start.lambda[0] < 0.04F) continue;
    const Plane plane = detail::fitDominant(offsets, start, 0.1F);
    if (!plane.valid) continue;
    ++at_edges;
    right += angleBetween(sample.normals[i], plane.normal.data()) < 5.0 * kDegree ? 1 : 0;
    for (const char* set : kSets) {
      setenv("SEGORIENT_SIMD", set, 1);
      const Plane other = detail::fitDominant(offsets, start, 0.1F);
      unsetenv("SEGORIENT_SIMD");
      ASSERT_EQ(other.normal, plane.normal) << set;
      ASSERT_EQ(other.lambda, plane.lambda) << set;
    }
  }
  EXPECT_GT(at_edges, points.size / 10);
  EXPECT_GT(static_cast<double>(right), 0.85 * static_cast<double>(at_edges));
}

}  // namespace
}  // namespace segorient::test
