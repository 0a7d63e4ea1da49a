// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Planes of many points at once, against those of one point in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "feature_clouds.h"
#include "features/grown_planes.h"

namespace segorient::test {
namespace {

using detail::GrownPlanes;
using detail::Plane;

constexpr std::array<int, 3> kSizes{8, 18, 40};
using Planes = std::array<GrownPlanes, kSizes.size()>;

std::unique_ptr<Planes> planesOf(const PointView& points, const Neighborhoods& table,
                                 std::size_t begin, std::size_t end) {
  auto planes = std::make_unique<Planes>();
  const detail::FourFloats xyz(points);
  detail::fitGrownPlanes(detail::jobOf(points, xyz, table, kSizes.back()), kSizes.data(),
                         kSizes.size(), begin, end, planes->data());
  return planes;
}

Plane planeOf(const PointView& points, const Neighborhoods& table, std::size_t i, int k) {
  detail::Moments m;
  for (int j = 0; j <= k && j < table.count(i); ++j) {
    const float* q = points[static_cast<std::size_t>(table.indices(i)[j])];
    m.add(q[0] - points[i][0], q[1] - points[i][1], q[2] - points[i][2]);
  }
  return detail::fitPlane(m);
}

TEST(GrownPlanes, EqualThoseOfOnePoint) {
  for (const Sample& sample : {torus(4000, 11), torus(4000, 12, 0.02F), cube(4000, 13)}) {
    const PointView points = sample.view();
    const Neighborhoods table = neighborsOf(points, 45);
    for (std::size_t begin = 0; begin < 4000; begin += GrownPlanes::kRows) {
      const std::size_t end = std::min<std::size_t>(4000, begin + GrownPlanes::kRows);
      const auto planes = planesOf(points, table, begin, end);
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t s = 0; s < kSizes.size(); ++s) {
          const Plane expected = planeOf(points, table, i, kSizes[s]);
          const Plane found = (*planes)[s].at(i - begin);
          ASSERT_TRUE(found.valid);
          ASSERT_EQ((*planes)[s].n[i - begin], static_cast<float>(kSizes[s] + 1));
          const float size = expected.lambda[2];
          for (int a = 0; a < 3; ++a) {
            // The larger two are less exact where they meet.
            ASSERT_NEAR(found.lambda[a], expected.lambda[a], (a == 0 ? 1e-5F : 1e-3F) * size) << i;
            ASSERT_NEAR(found.mean[a], expected.mean[a], 1e-5F * std::sqrt(size));
          }
          // A hundredth of a degree, where the plane is clearly one.
          if (expected.lambda[1] - expected.lambda[0] < 0.1F * size) continue;
          ASSERT_GT(std::fabs(found.normal.dot(expected.normal)), 1.F - 1e-6F) << i;
        }
      }
    }
  }
}

TEST(GrownPlanes, SameForAnyInstructionSet) {
  const Sample sample = torus(1000, 14, 0.02F);
  const Neighborhoods table = neighborsOf(sample.view(), 45);
  const auto first = planesOf(sample.view(), table, 0, 250);
  for (const char* instruction_set : {"avx2", "sse2"}) {
    setenv("SEGORIENT_SIMD", instruction_set, 1);
    const auto other = planesOf(sample.view(), table, 0, 250);
    unsetenv("SEGORIENT_SIMD");
    for (std::size_t s = 0; s < kSizes.size(); ++s) {
      for (std::size_t i = 0; i < 250; ++i) {
        const Plane a = (*first)[s].at(i);
        const Plane b = (*other)[s].at(i);
        ASSERT_EQ(a.lambda, b.lambda) << instruction_set;
        ASSERT_EQ(a.normal, b.normal) << instruction_set;
        ASSERT_EQ(a.mean, b.mean) << instruction_set;
      }
    }
  }
}

// A line has no plane, a ball of points no clear one, points in one place have nothing.
TEST(GrownPlanes, WithoutAPlane) {
  std::vector<float> line;
  for (int i = 0; i < 50; ++i) line.insert(line.end(), {static_cast<float>(i), 2.F, 3.F, 0.F});
  const PointView on_line{line.data(), 4, 50};
  EXPECT_FALSE(planesOf(on_line, neighborsOf(on_line, 45), 0, 50)->front().at(25).valid);

  std::vector<float> place(4 * 50, 1.F);
  const PointView in_place{place.data(), 4, 50};
  EXPECT_FALSE(planesOf(in_place, neighborsOf(in_place, 45), 0, 50)->front().at(7).valid);

  // Corners of an octahedron around the middle: all variances are equal.
  std::vector<float> ball{0.F, 0.F, 0.F, 0.F};
  for (int a = 0; a < 3; ++a) {
    for (const float side : {-1.F, 1.F}) {
      std::vector<float> corner(4);
      corner[static_cast<std::size_t>(a)] = side;
      ball.insert(ball.end(), corner.begin(), corner.end());
    }
  }
  const PointView round{ball.data(), 4, 7};
  const auto planes = planesOf(round, neighborsOf(round, 6), 0, 1);
  for (const auto& lambda : planes->front().lambda) EXPECT_NEAR(lambda[0], 2.F / 7.F, 1e-5F);
}

TEST(Medians, EqualSorted) {
  std::mt19937 rng(15);
  std::uniform_real_distribution<float> uniform(-1.F, 1.F);
  constexpr std::size_t kRows = GrownPlanes::kRows;
  for (const std::size_t count : {1U, 2U, 7U, 23U}) {
    std::vector<float> values(count * kRows);
    for (float& v : values) {
      v = uniform(rng);
      // Some are missing, and many are the same.
      if (v < -0.6F) v = std::numeric_limits<float>::quiet_NaN();
      if (v > 0.5F) v = 0.5F;
    }
    std::vector<float> medians(kRows);
    detail::findMedians(values.data(), count, medians.data());
    for (std::size_t i = 0; i < kRows; ++i) {
      std::vector<float> sorted;
      for (std::size_t j = 0; j < count; ++j) {
        if (!std::isnan(values[j * kRows + i])) sorted.push_back(values[j * kRows + i]);
      }
      std::sort(sorted.begin(), sorted.end());
      if (sorted.empty()) {
        ASSERT_TRUE(std::isnan(medians[i]));
      } else {
        ASSERT_EQ(medians[i], sorted[sorted.size() / 2]) << count << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace segorient::test
