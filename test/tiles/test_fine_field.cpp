// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The field of parts hardly thicker than points are apart: found once, taken part by part.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "orientation/automatic/noise_field.h"
#include "search/prepared_cloud.h"
#include "tiles/cloud_field.h"

namespace segorient::test {
namespace {

constexpr int kNeighbors = 8;

// A lens, 4 wide and 1.2 thick in the middle, whose sides meet in an edge.
struct Lens {
  std::vector<float> xyz;
  std::vector<float> normals;  // 4 a point, outward but for a patch near the edge
  std::size_t wrong = 0;

  explicit Lens(std::size_t size) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-2.F, 2.F);
    while (xyz.size() < 3 * size) {
      const float x = uniform(random);
      const float y = uniform(random);
      if (x * x + y * y > 4.F) continue;
      const float side = xyz.size() % 2 == 0 ? 1.F : -1.F;
      xyz.insert(xyz.end(), {x, y, side * 0.15F * (4.F - x * x - y * y)});
      float n[3] = {0.3F * x, 0.3F * y, side};
      const float length = std::hypot(n[0], n[1], n[2]);
      const bool turned = side > 0.F && std::hypot(x - 0.1F, y - 1.7F) < 0.25F;
      wrong += turned ? 1 : 0;
      for (const float v : n) normals.push_back((turned ? -v : v) / length);
      normals.push_back(0.F);
    }
  }
  std::size_t size() const { return xyz.size() / 3; }
  PointView points() const { return {xyz.data(), 3, size()}; }
};

// Some rows of it as a cloud of their own.
struct Part {
  std::vector<std::size_t> rows;
  std::vector<float> xyz;
  PreparedCloud cloud;
  detail::AutoNormals found;

  template <typename Has>
  Part(const Lens& lens, const Has& has) {
    for (std::size_t i = 0; i < lens.size(); ++i) {
      if (!has(lens.points()[i])) continue;
      rows.push_back(i);
      xyz.insert(xyz.end(), lens.points()[i], lens.points()[i] + 3);
    }
    cloud = PreparedCloud({xyz.data(), 3, rows.size()}, nullptr, 1);
    cloud.findNeighbors(kNeighbors, false);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float* n = &lens.normals[4 * rows[cloud.rowOf(i)]];
      found.normals.insert(found.normals.end(), n, n + 4);
    }
    found.confidences.assign(cloud.size(), 1.F);
  }
  void copyNormals(std::vector<float>& out) const {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for (std::size_t a = 0; a < 4; ++a) {
        out[4 * rows[cloud.rowOf(i)] + a] = found.normals[4 * i + a];
      }
    }
  }
};

std::size_t facingInward(const Lens& lens, const std::vector<float>& normals) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < lens.size(); ++i) {
    count += normals[4 * i + 2] * lens.xyz[3 * i + 2] < 0.F ? 1 : 0;
  }
  return count;
}

TEST(FineFieldOfTiles, PartsTakeWhatTheWholeTakes) {
  const Lens lens(9000);
  Part whole(lens, [](const float*) { return true; });
  const detail::NoiseField taken =
      detail::takeFineField(whole.cloud.points(), whole.cloud.neighborhoods(), 1, whole.found);
  ASSERT_FALSE(taken.empty());
  std::vector<float> expected(lens.normals.size());
  whole.copyNormals(expected);
  EXPECT_LT(facingInward(lens, expected), lens.wrong);

  const std::vector<float> sure(lens.size(), 1.F);
  const CloudField field = detail::findFine(lens.points(), lens.normals, sure, 1);
  ASSERT_FALSE(field.cells.empty());
  std::vector<float> normals(lens.normals.size());
  for (const bool upper : {false, true}) {
    Part part(lens, [&](const float* p) { return (p[0] + p[1] > 1.7F) == upper; });
    detail::takeField(part.cloud.points(), part.cloud.neighborhoods(), part.cloud.unit(), field, 1,
                      part.found);
    part.copyNormals(normals);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) ASSERT_NEAR(normals[i], expected[i], 0.01) << i;
}

}  // namespace
}  // namespace segorient::test
