// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Numbers in few bits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tiles/bit_stream.h"
#include "tiles/packed_values.h"
#include "tiles/point_packets.h"

namespace segorient::program {
namespace {

TEST(Packing, BitsComeBackInOrder) {
  std::vector<std::uint8_t> bytes;
  BitWriter out(bytes);
  std::mt19937_64 random(3);
  std::vector<std::pair<std::uint64_t, unsigned>> numbers;
  for (unsigned i = 0; i < 1000; ++i) {
    const unsigned bits = i % 57;
    numbers.emplace_back(random() & ((std::uint64_t{1} << bits) - 1), bits);
    out.put(numbers.back().first, bits);
  }
  out.flush();
  BitReader in(bytes.data(), bytes.size());
  for (const auto& [number, bits] : numbers) ASSERT_EQ(in.get(bits), number);
  EXPECT_EQ(in.get(8), 0U);  // behind the end
}

TEST(Packing, StepsOfAnySizeComeBack) {
  const RiceCode code(1000, 10);
  const std::vector<std::uint64_t> steps{0, 1, 99, 100, 5000, 1U << 31, std::uint64_t{1} << 45};
  std::vector<std::uint8_t> bytes;
  BitWriter out(bytes);
  for (const std::uint64_t s : steps) code.put(s, out);
  out.flush();
  BitReader in(bytes.data(), bytes.size());
  for (const std::uint64_t s : steps) EXPECT_EQ(code.get(in), s);
}

TEST(Packing, NormalsKeepTheirDirection) {
  std::mt19937 random(5);
  std::normal_distribution<float> gauss;
  for (int i = 0; i < 20000; ++i) {
    float n[3] = {gauss(random), gauss(random), gauss(random)};
    if (i < 6) {
      for (int a = 0; a < 3; ++a) n[a] = a == i / 2 ? (i % 2 == 0 ? 1.F : -1.F) : 0.F;
    }
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (float& x : n) x /= length;
    for (const auto& [bits, degrees] : {std::pair<unsigned, float>{16U, 1.F}, {26U, 0.03F}}) {
      float m[3];
      const std::uint32_t packed = packNormal(n, bits);
      ASSERT_LT(packed, (std::uint64_t{1} << bits) - 1);  // that stands for no normal
      unpackNormal(packed, bits, m);
      float off = 0.F;
      for (int a = 0; a < 3; ++a) off += (m[a] - n[a]) * (m[a] - n[a]);
      ASSERT_LT(std::sqrt(off) * 57.3F, degrees) << n[0] << ' ' << n[1] << ' ' << n[2];
      // Axes are exact: planes along them are common.
      if (i < 6) {
        ASSERT_EQ(off, 0.F) << i;
      }
    }
  }
}

TEST(Packing, CurvaturesKeepTwoDigits) {
  EXPECT_EQ(unpackCurvature(packCurvature(0.F)), 0.F);
  EXPECT_EQ(unpackCurvature(packCurvature(std::numeric_limits<float>::quiet_NaN())), 0.F);
  EXPECT_EQ(unpackCurvature(packCurvature(1e-20F)), 0.F);
  for (float c = 1e-8F; c < 0.34F; c *= 1.07F) {
    ASSERT_NEAR(unpackCurvature(packCurvature(c)) / c, 1.F, 0.004F) << c;
  }
}

// Floats at any place, doubles at UTM size, points in one place, numbers far apart, viewpoints.
TEST(Packing, PointsComeBackExactly) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int kind = 0; kind < 4; ++kind) {
    const PointFields fields{true, kind == 1};
    std::vector<StoredPoint> points(kind == 3 ? 1 : 500);
    std::uint32_t row = 123456789;
    for (StoredPoint& p : points) {
      row += 1 + static_cast<std::uint32_t>(random() % (kind == 1 ? 8000000ULL : 50ULL));
      p.number = row;
      for (double& x : p.place) {
        x = uniform(random);
        if (kind == 0) x = static_cast<double>(static_cast<float>(x));
        if (kind == 1) x = 5400000.0 + std::ldexp(std::round(std::ldexp(x, 20)), -14);
        if (kind == 2) x = 0.25;
      }
      if (fields.normals) p.normal = {0.F, row % 2 == 0 ? 1.F : 0.F, 0.F};
      p.seen_from = {static_cast<float>(kind), std::numeric_limits<float>::quiet_NaN(),
                     kind == 1 ? static_cast<float>(row % 7) : 0.F};
    }
    std::vector<std::uint8_t> packet;
    packPoints(points.data(), points.size(), fields, packet);
    std::vector<StoredPoint> back;
    ASSERT_TRUE(unpackPoints(packet, points.size(), fields, back));
    ASSERT_EQ(back.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(back[i].number, points[i].number) << kind;
      ASSERT_EQ(back[i].place, points[i].place) << kind;
      ASSERT_EQ(back[i].normal, points[i].normal) << kind;
      ASSERT_EQ(std::memcmp(&back[i].seen_from, &points[i].seen_from, 12), 0) << kind;
    }
    if (kind == 2) {
      EXPECT_LT(packet.size(), 2 * points.size());
    }
    EXPECT_FALSE(unpackPoints({1, 2, 3}, points.size(), fields, back));
  }
}

}  // namespace
}  // namespace segorient::program
