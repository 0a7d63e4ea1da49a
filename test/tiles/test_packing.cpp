// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Numbers in few bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "run_program.h"
#include "tiles/bit_stream.h"
#include "tiles/packed_values.h"
#include "tiles/point_packets.h"
#include "tiles/row_file.h"

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

TEST(Packing, NumbersOfAnySizeComeBack) {
  const std::vector<std::uint32_t> numbers{0, 1, 2, 3, 99, 100, 5000, 1U << 31, 0xffffffffU};
  for (unsigned bits = 0; bits < 16; ++bits) {
    const GolombCode code(bits);
    std::vector<std::uint8_t> bytes;
    BitWriter out(bytes);
    for (const std::uint32_t n : numbers) code.put(n, out);
    out.flush();
    BitReader in(bytes.data(), bytes.size());
    for (const std::uint32_t n : numbers) EXPECT_EQ(code.get(in), n) << bits;
  }
  EXPECT_EQ(GolombCode::best({0, 0, 1, 0}, 12).bits(), 0U);
  EXPECT_GT(GolombCode::best({1000, 700, 2000, 1500}, 12).bits(), 7U);
  for (const std::int32_t x : {0, 1, -1, 4096, -4096, 2147483647}) {
    EXPECT_EQ(unfoldSign(foldSign(x)), x);
  }
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

// Floats at any place, doubles at UTM size, points in one place, on a plane and side by side,
// viewpoints few and many.
TEST(Packing, PointsComeBackExactly) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int kind = 0; kind < 6; ++kind) {
    const PointFields fields{true, kind == 1};
    std::vector<StoredPoint> points(kind == 3 ? 1 : 500);
    std::uint32_t row = 0;
    PlaceOrder order;
    for (StoredPoint& p : points) {
      ++row;
      for (double& x : p.place) {
        x = uniform(random);
        if (kind == 0 || kind == 4) x = static_cast<double>(static_cast<float>(x));
        if (kind == 1) x = 5400000.0 + std::ldexp(std::round(std::ldexp(x, 20)), -14);
        if (kind == 2) x = 0.25;
        if (kind == 5) x = std::round(3.0 * x);  // many in each place
      }
      if (kind == 4) p.place[2] = 17.0;
      order.add(p.place);
      if (fields.normals) p.normal = {0.F, row % 2 == 0 ? 1.F : 0.F, 0.F};
      p.seen_from = {static_cast<float>(kind), std::numeric_limits<float>::quiet_NaN(),
                     kind == 1 ? static_cast<float>(row % 70) : static_cast<float>(row % 3)};
    }
    std::vector<std::uint8_t> packet;
    packPoints(points.data(), order, fields, packet);
    std::vector<StoredPoint> back;
    ASSERT_TRUE(unpackPoints(packet, points.size(), fields, back));
    ASSERT_EQ(back.size(), points.size());
    std::vector<std::uint8_t> seen(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const StoredPoint& p = points[order.at(i)];
      ++seen[order.at(i)];
      ASSERT_EQ(back[i].place, p.place) << kind;
      ASSERT_EQ(back[i].normal, p.normal) << kind;
      ASSERT_EQ(std::memcmp(&back[i].seen_from, &p.seen_from, 12), 0) << kind;
      if (i > 0 && back[i].place == back[i - 1].place) {
        ASSERT_LT(order.at(i - 1), order.at(i)) << kind;
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
    if (kind == 2) {
      EXPECT_LT(packet.size(), 2 * points.size());
    }
    // The order alone, as write finds it.
    PlaceOrder again;
    for (const StoredPoint& p : points) again.add(p.place);
    again.order(nullptr);
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(again.at(i), order.at(i));
    EXPECT_FALSE(unpackPoints({1, 2, 3}, points.size(), fields, back));
  }
}

// Rows of several pieces, with and without normals, from any point on.
TEST(Packing, RowsComeBack) {
  const test::ScratchDirectory scratch;
  std::mt19937 random(11);
  std::normal_distribution<float> gauss;
  std::vector<RowRecord> rows(5000);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    RowRecord& r = rows[i];
    float n[3] = {1.F, 0.1F * gauss(random), 0.1F * gauss(random)};
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int a = 0; a < 3; ++a) r.normal[a] = n[a] / length;
    r.normal[3] = 0.01F;
    if (i % 17 == 0) std::fill_n(r.normal, 4, std::numeric_limits<float>::quiet_NaN());
    r.label = i < 4000 ? static_cast<std::int32_t>(random() % 3) : -1;
    r.followed = static_cast<std::int32_t>(i % 2);
  }
  const std::string path = scratch.file("rows");
  saveRows(rows, {{0, 0, 0}, {2500, 1, 0}}, path, 1, 2);
  for (const std::size_t output : {0U, 1U}) {
    RowReader reader(path, 1, 2, static_cast<std::uint32_t>(output));
    for (std::size_t i = 2500 * output; i < rows.size(); ++i, reader.next()) {
      ASSERT_FALSE(reader.done());
      const RowRecord& r = reader.row();
      ASSERT_EQ(r.label, rows[i].label);
      ASSERT_EQ(r.followed, rows[i].followed);
      ASSERT_EQ(std::isnan(r.normal[0]), i % 17 == 0);
      for (int a = 0; a < 3 && i % 17 != 0; ++a) ASSERT_NEAR(r.normal[a], rows[i].normal[a], 5e-4F);
      if (i % 17 != 0) {
        ASSERT_NEAR(r.normal[3], 0.01F, 1e-4F);
      }
    }
    EXPECT_TRUE(reader.done());
  }
  // Within a block, into another, onto its first row, and behind the last one.
  RowReader reader(path, 1, 2, 1);
  std::size_t at = 2500;
  for (const std::size_t on : {0U, 3U, 1000U, 593U, 400U}) {
    reader.skip(on);
    at += on;
    ASSERT_FALSE(reader.done());
    EXPECT_EQ(reader.row().label, rows[at].label) << at;
    EXPECT_EQ(reader.row().followed, rows[at].followed) << at;
  }
  reader.skip(rows.size() - at);
  EXPECT_TRUE(reader.done());
}

}  // namespace
}  // namespace segorient::program
