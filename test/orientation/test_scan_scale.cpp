// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Normals where the nearest neighbours are of one ring, or below the noise: planes are the oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "features/scan_scale.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

// A plane of lines ten times as far apart as points along them, with noise across it of as much as
// these are apart.
std::vector<float> ringPlane(unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> gauss(0.F, 0.02F);
  std::vector<float> xyz;
  for (int line = 0; line < 20; ++line) {
    for (int i = 0; i < 200; ++i) {
      const float x = 0.02F * static_cast<float>(i) + gauss(rng);
      const float y = 0.2F * static_cast<float>(line);
      xyz.insert(xyz.end(), {x, y, 0.3F * x + 0.5F * y + gauss(rng), 0.F});
    }
  }
  return xyz;
}

double shareOfPlane(const std::vector<float>& xyz, bool scan_lines) {
  SheetNormalOptions options;
  options.scan_scales = false;
  options.scan_lines = scan_lines;
  const SheetNormals sheets = estimateSheetNormals(viewOf(xyz), neighborsOf(xyz), options);
  std::vector<float> truth;
  const float length = std::sqrt(1.F + 0.3F * 0.3F + 0.5F * 0.5F);
  for (std::size_t i = 0; i < xyz.size() / 4; ++i) {
    truth.insert(truth.end(), {-0.3F / length, -0.5F / length, 1.F / length, 0.F});
  }
  return shareWithin(sheets.normals, truth, 15.0);
}

TEST(ScanScale, NeighboursSpanSeveralRings) {
  const std::vector<float> xyz = ringPlane(80);
  EXPECT_LT(shareOfPlane(xyz, false), 0.7) << "one ring has any normal";
  EXPECT_GE(shareOfPlane(xyz, true), 0.95);
}

TEST(ScanScale, EvenCloudsKeepTheirNormals) {
  for (const double noise : {0.0, 0.1}) {
    const LabelledCloud cloud = sample("bracket", bracket(), 8000, 81, noise);
    SheetNormalOptions with;
    with.scan_scales = true;
    const Neighborhoods table = neighborsOf(cloud.xyz);
    EXPECT_EQ(estimateSheetNormals(viewOf(cloud.xyz), table).normals,
              estimateSheetNormals(viewOf(cloud.xyz), table, with).normals);
  }
}

TEST(ScanScale, LinesOfAScannerShowButNoChance) {
  const std::vector<float> rings = ringPlane(82);
  EXPECT_TRUE(detail::showsScanLines(viewOf(rings), neighborsOf(rings), 0));
  const LabelledCloud even = sample("bracket", bracket(), 8000, 83, 0.0);
  EXPECT_FALSE(detail::showsScanLines(viewOf(even.xyz), neighborsOf(even.xyz), 0));
}

// Two scans of a plane with the same noise, one from so near that its spacing is a quarter.
std::vector<float> nearAndFar(double share_near, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> gauss(0.F, 0.04F);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> xyz;
  const auto add = [&](float from, float side, int count) {
    for (int i = 0; i < count; ++i) {
      xyz.insert(xyz.end(), {from + side * unit(rng), side * unit(rng), gauss(rng), 0.F});
    }
  };
  add(0.F, 8.F, 3200);
  if (share_near > 0.0) add(10.F, 2.F, static_cast<int>(3200 * share_near));
  return xyz;
}

TEST(ScanScale, NoiseBelowASpacingThatVariesAsksForMore) {
  const std::vector<float> even = nearAndFar(0.0, 85);
  const std::vector<float> uneven = nearAndFar(1.0, 86);
  EXPECT_FALSE(detail::isUneven(viewOf(even), neighborsOf(even)));
  EXPECT_TRUE(detail::isUneven(viewOf(uneven), neighborsOf(uneven)));
  EXPECT_FALSE(detail::isUneven({nullptr, 4, 0}, {}));
  const auto sheets = [](const std::vector<float>& xyz, bool scan_lines) {
    SheetNormalOptions options;
    options.scan_lines = scan_lines;
    return estimateSheetNormals(viewOf(xyz), neighborsOf(xyz), options);
  };
  EXPECT_FALSE(sheets(even, true).traits.scan_scales);
  EXPECT_FALSE(sheets(uneven, false).traits.scan_scales);
  const SheetNormals found = sheets(uneven, true);
  EXPECT_TRUE(found.traits.scan_scales);
  std::vector<float> truth;
  for (std::size_t i = 0; i < uneven.size() / 4; ++i) {
    truth.insert(truth.end(), {0.F, 0.F, 1.F, 0.F});
  }
  EXPECT_GT(shareWithin(found.normals, truth, 15.0),
            shareWithin(sheets(uneven, false).normals, truth, 15.0) + 0.1);
}

// More points than one region of the index has: those at rims wait for the ones behind them.
TEST(ScanScale, EachPointIsTakenOnceByAnyNumberOfThreads) {
  std::mt19937 rng(84);
  std::normal_distribution<float> gauss(0.F, 1.F);
  std::uniform_real_distribution<float> uniform(0.F, 150.F);
  std::vector<float> xyz;
  for (int i = 0; i < 22500; ++i) {
    xyz.insert(xyz.end(), {uniform(rng), uniform(rng), 0.5F * gauss(rng), 0.F});
  }
  const std::size_t n = xyz.size() / 4;
  std::vector<float> first;
  for (const int threads : {1, 4}) {
    std::vector<float> normals(3 * n, 0.F);
    std::vector<int> times(n, 0);
    detail::MoreNeighbors more(viewOf(xyz), threads);
    detail::fitScanPlanes(more, 8, threads,
                          [&](std::size_t i, const detail::GrownPlanes& planes, std::size_t r) {
                            for (std::size_t a = 0; a < 3; ++a)
                              normals[3 * i + a] = planes.normal[a][r];
                            ++times[i];
                          });
    std::size_t level = 0;
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_LE(times[i], 1);
      level += std::fabs(normals[3 * i + 2]) > 0.97F ? 1 : 0;
    }
    EXPECT_GT(level, n * 9 / 10) << "noise of half a spacing asks for large neighbourhoods";
    if (first.empty()) first = normals;
    EXPECT_EQ(normals, first);
  }
}

TEST(ScanScale, FewPointsAndLines) {
  std::vector<float> line;
  for (int i = 0; i < 40; ++i) line.insert(line.end(), {static_cast<float>(i), 0.F, 0.F, 0.F});
  const auto fail = [](std::size_t, const detail::GrownPlanes&, std::size_t) {
    FAIL() << "a line has no plane";
  };
  detail::MoreNeighbors more(viewOf(line), 0);
  detail::fitScanPlanes(more, 8, 0, fail);
  detail::MoreNeighbors none({nullptr, 4, 0}, 0);
  detail::fitScanPlanes(none, 8, 0, fail);
}

}  // namespace
}  // namespace segorient::test
