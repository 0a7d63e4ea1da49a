// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Sheets: normals, denoising, segments and the final filter on thin walls, edges and noise.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "features/sheet_denoise.h"
#include "orientation/automatic/sheet_filter.h"
#include "segmentation/sheet_edges.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

TEST(SheetNormals, SeparateTheWallsOfAThinPlate) {
  const LabelledCloud cloud = sample("plate", plate(2, 8000), 8000, 3);
  const Neighborhoods table = neighborsOf(cloud.xyz);
  const SheetNormals with = estimateSheetNormals(viewOf(cloud.xyz), table);
  SheetNormalOptions off;
  off.split_walls = false;
  off.dominant_plane = false;
  const SheetNormals without = estimateSheetNormals(viewOf(cloud.xyz), table, off);
  const double share = shareWithin(with.normals, cloud.normals, 10);
  EXPECT_GT(share, 0.93);
  EXPECT_GT(share, shareWithin(without.normals, cloud.normals, 10) + 0.05);
}

TEST(SheetNormals, TellNeighboursOnTheOtherWall) {
  const LabelledCloud cloud = sample("plate", plate(1, 8000), 8000, 4);
  const Neighborhoods table = neighborsOf(cloud.xyz);
  const SheetNormals sheets = estimateSheetNormals(viewOf(cloud.xyz), table);
  std::size_t right = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.face[i] > 1) continue;  // faces 0 and 1 are the walls
    for (int j = 1; j < table.count(i); ++j) {
      const auto q = static_cast<std::size_t>(table.indices(i)[j]);
      if (cloud.face[q] > 1) continue;
      float d[3];
      for (std::size_t a = 0; a < 3; ++a) d[a] = cloud.xyz[4 * q + a] - cloud.xyz[4 * i + a];
      const float offset = dot3(d, &sheets.normals[4 * i]);
      const bool own = offset > sheets.below[i] && offset < sheets.above[i];
      right += own == (cloud.face[q] == cloud.face[i]) ? 1U : 0U;
      ++all;
    }
  }
  EXPECT_GT(static_cast<double>(right), 0.8 * static_cast<double>(all)) << "half without the split";
}

// Normals have no sign, and which one a fit returns depends on their direction. Around a point it
// must stay the same from fit to fit, or its own wall would be the other one.
TEST(SheetNormals, TellWallsInAnyDirection) {
  const LabelledCloud cloud = sample("plate", plate(1, 8000), 8000, 4, 0.15);
  const Neighborhoods table = neighborsOf(cloud.xyz);
  const auto onOwnWall = [&](const std::vector<float>& xyz) {
    const SheetNormals sheets = estimateSheetNormals(viewOf(xyz), table);
    std::vector<bool> own;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      for (int j = 1; j < table.count(i); ++j) {
        const auto q = static_cast<std::size_t>(table.indices(i)[j]);
        float d[3];
        for (std::size_t a = 0; a < 3; ++a) d[a] = xyz[4 * q + a] - xyz[4 * i + a];
        const float offset = dot3(d, &sheets.normals[4 * i]);
        own.push_back(offset > sheets.below[i] && offset < sheets.above[i]);
      }
    }
    return own;
  };
  const std::vector<bool> level = onOwnWall(cloud.xyz);
  // Half a right angle: two components of the walls' normals are equal.
  std::vector<float> tilted = cloud.xyz;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float y = cloud.xyz[4 * i + 1];
    const float z = cloud.xyz[4 * i + 2];
    tilted[4 * i + 1] = std::sqrt(0.5F) * (y + z);
    tilted[4 * i + 2] = std::sqrt(0.5F) * (z - y);
  }
  const std::vector<bool> other = onOwnWall(tilted);
  std::size_t different = 0;
  for (std::size_t i = 0; i < level.size(); ++i) different += level[i] != other[i] ? 1U : 0U;
  EXPECT_LT(different, level.size() / 2000);
}

TEST(SheetNormals, KeepToOneFaceAtEdges) {
  const LabelledCloud cloud = sample("cube", cube(), 6000, 5);
  const Neighborhoods table = neighborsOf(cloud.xyz);
  SheetNormalOptions off;
  off.dominant_plane = false;
  const double with =
      shareWithin(estimateSheetNormals(viewOf(cloud.xyz), table).normals, cloud.normals, 10);
  const double without =
      shareWithin(estimateSheetNormals(viewOf(cloud.xyz), table, off).normals, cloud.normals, 10);
  EXPECT_GT(with, 0.95);
  EXPECT_GT(with, without + 0.03);
}

TEST(SheetNormals, DegenerateCloudsHaveNone) {
  const std::vector<float> line{0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0};
  const SheetNormals sheets = estimateSheetNormals(viewOf(line), neighborsOf(line));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(sheets.normals[4 * i])) << i;
  const std::vector<float> one{1, 2, 3, 0};
  EXPECT_TRUE(std::isnan(estimateSheetNormals(viewOf(one), neighborsOf(one)).normals[0]));
  const std::vector<float> none;
  EXPECT_TRUE(estimateSheetNormals(viewOf(none), Neighborhoods{}).normals.empty());
}

TEST(SheetNormals, DoNotDependOnScale) {
  const LabelledCloud cloud = sample("cube", cube(), 3000, 6);
  const SheetNormals plain = estimateSheetNormals(viewOf(cloud.xyz), neighborsOf(cloud.xyz));
  for (const float scale : {0x1p-60F, 0x1p60F}) {  // powers of two: nothing is rounded
    std::vector<float> scaled = cloud.xyz;
    for (float& v : scaled) v *= scale;
    Neighborhoods table = neighborsOf(cloud.xyz);
    const SheetNormals other = estimateSheetNormals(viewOf(scaled), table);
    EXPECT_EQ(plain.normals, other.normals) << scale;
  }
}

TEST(Noise, IsMeasuredInSpacings) {
  const auto level = [](double sigma) {
    const LabelledCloud cloud = sample("cube", cube(), 6000, 7, sigma);
    return measureNoise(viewOf(cloud.xyz), neighborsOf(cloud.xyz));
  };
  const NoiseLevel clean = level(0);
  const NoiseLevel some = level(0.25);
  const NoiseLevel much = level(2);
  EXPECT_LT(clean.fine, 0.02F);
  EXPECT_NEAR(some.fine, 0.25F, 0.07F);  // sigma over the mean distance to the 6 nearest
  EXPECT_FALSE(needsDenoising(clean));
  EXPECT_FALSE(needsDenoising(some));
  EXPECT_TRUE(needsDenoising(much));
}

TEST(Noise, ThinWallsAreNotNoise) {
  const LabelledCloud cloud = sample("plate", plate(2, 6000), 6000, 8);
  const NoiseLevel level = measureNoise(viewOf(cloud.xyz), neighborsOf(cloud.xyz));
  EXPECT_LT(level.fine, 0.05F);
  EXPECT_FALSE(needsDenoising(level));
}

// Two spacings apart and with noise of a quarter, the other wall is among the 8 nearest, and looks
// like noise of a third. A single noisy sheet is no two walls.
TEST(Noise, OfThinWallsIsThatOfEachWall) {
  const auto level = [](const std::vector<Face>& faces, double sigma) {
    const LabelledCloud cloud = sample("solid", faces, 8000, 8, sigma);
    return measureNoise(viewOf(cloud.xyz), neighborsOf(cloud.xyz));
  };
  const NoiseLevel walls = level(plate(2, 8000), 0.25);
  EXPECT_TRUE(walls.thin);
  EXPECT_NEAR(walls.fine, 0.22F, 0.04F);  // somewhat low: see NoiseLevel
  EXPECT_FALSE(needsDenoising(walls));
  EXPECT_FALSE(level(plate(2, 8000), 0).thin) << "8 neighbours are of one wall";
  EXPECT_TRUE(level(plate(1, 8000), 0).thin) << "8 neighbours are of both";
  for (const double sigma : {0.25, 0.5, 1.0, 2.0}) {
    EXPECT_FALSE(level(cube(), sigma).thin) << sigma;
  }
}

TEST(Denoising, BringsPointsNearerToTheSurface) {
  std::mt19937 rng(9);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::normal_distribution<float> noise(0.F, 0.03F);  // about 1.9 spacings
  std::vector<float> xyz;
  for (int i = 0; i < 4000; ++i) xyz.insert(xyz.end(), {unit(rng), unit(rng), noise(rng), 0.F});
  search::MedianHashIndex index;
  index.build(viewOf(xyz), nullptr, {});
  const std::vector<float> moved = projectOnPlanes(viewOf(xyz), index, 48);
  double before = 0.0;
  double after = 0.0;
  for (std::size_t i = 0; i < 4000; ++i) {
    before += static_cast<double>(xyz[4 * i + 2]) * static_cast<double>(xyz[4 * i + 2]);
    after += static_cast<double>(moved[4 * i + 2]) * static_cast<double>(moved[4 * i + 2]);
  }
  EXPECT_LT(after, before / 4.0);
}

TEST(SheetSegmentation, NeverMixesTheWallsOfAPlate) {
  for (const double sigma : {0.0, 0.1}) {
    const LabelledCloud cloud = sample("plate", plate(2, 8000), 8000, 10, sigma);
    const Neighborhoods table = neighborsOf(cloud.xyz);
    const SheetNormals sheets = estimateSheetNormals(viewOf(cloud.xyz), table);
    const SheetField field = fieldOf(sheets);
    const Segmentation segments = segmentSheets(viewOf(cloud.xyz), table, field);
    std::size_t mixed = 0;
    for (std::size_t s = 0; s < segments.segments.size(); ++s) {
      std::size_t outward = 0;
      for (const auto* p = segments.begin(s); p != segments.end(s); ++p) {
        const auto i = static_cast<std::size_t>(*p);
        const float d = dot3(&sheets.normals[4 * i], &cloud.normals[4 * i]);
        outward += d * static_cast<float>(segments.signs[i]) > 0.F ? 1U : 0U;
      }
      mixed += std::min<std::size_t>(outward, segments.segments[s].size - outward);
    }
    EXPECT_LT(mixed, cloud.size() / 200) << sigma;
  }
}

TEST(SheetSegmentation, CoversEveryPointThatHasANormal) {
  const LabelledCloud cloud = sample("bracket", bracket(), 5000, 11);
  const Neighborhoods table = neighborsOf(cloud.xyz);
  const SheetNormals sheets = estimateSheetNormals(viewOf(cloud.xyz), table);
  const SheetField field = fieldOf(sheets);
  const Segmentation segments = segmentSheets(viewOf(cloud.xyz), table, field);
  ASSERT_EQ(segments.labels.size(), cloud.size());
  ASSERT_EQ(segments.members.size(), cloud.size());
  for (std::size_t s = 0; s < segments.segments.size(); ++s) {
    if (s > 0) {
      EXPECT_LE(segments.segments[s].size, segments.segments[s - 1].size);
    }
    for (const auto* p = segments.begin(s); p != segments.end(s); ++p) {
      EXPECT_EQ(segments.labels[static_cast<std::size_t>(*p)], static_cast<std::int32_t>(s));
    }
  }
}

TEST(SheetFilter, RightsALoneWrongSign) {
  const LabelledCloud cloud = sample("cube", cube(), 4000, 12);
  std::vector<float> oriented = cloud.normals;
  for (std::size_t i = 0; i < cloud.size(); i += 40) {
    for (std::size_t a = 0; a < 3; ++a) oriented[4 * i + a] = -oriented[4 * i + a];
  }
  const Neighborhoods table = neighborsOf(cloud.xyz);
  const std::vector<float> spacing(cloud.size(), static_cast<float>(cloud.spacing));
  const FilteredNormals filtered =
      filterOrientedNormals(viewOf(cloud.xyz), table, oriented, spacing, 0.01F);
  EXPECT_EQ(shareOutward(filtered.normals, cloud.normals), 1.0);
  EXPECT_GT(shareWithin(filtered.normals, cloud.normals, 10), 0.96);
}

TEST(SheetFilter, GivesANormalToAPointWithoutOne) {
  const LabelledCloud cloud = sample("cube", cube(), 2000, 13);
  std::vector<float> oriented = cloud.normals;
  for (std::size_t i = 0; i < cloud.size(); i += 50) {
    for (std::size_t a = 0; a < 4; ++a) oriented[4 * i + a] = std::nanf("");
  }
  const std::vector<float> spacing(cloud.size(), static_cast<float>(cloud.spacing));
  const FilteredNormals filtered =
      filterOrientedNormals(viewOf(cloud.xyz), neighborsOf(cloud.xyz), oriented, spacing, 0.01F);
  EXPECT_EQ(shareOutward(filtered.normals, cloud.normals), 1.0);
}

// Whole and broken groups of four, and rows of three floats.
TEST(SheetEdges, ListThePairsThatJoin) {
  const LabelledCloud cloud = sample("plate", plate(1, 3000), 3000, 8, 0.15);
  std::vector<float> packed;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    packed.insert(packed.end(), &cloud.xyz[4 * i], &cloud.xyz[4 * i] + 3);
  }
  const PointView of_three{packed.data(), 3, cloud.size()};
  for (const int k : {3, 6, 11, kSheetDegree, kSheetNeighbors}) {
    const Neighborhoods table = neighborsOf(cloud.xyz, k);
    SheetNormals sheets = estimateSheetNormals(viewOf(cloud.xyz), table);
    for (std::size_t i = 0; i < cloud.size(); i += 50) {
      std::fill_n(&sheets.normals[4 * i], 4, std::numeric_limits<float>::quiet_NaN());
    }
    for (const PointView& points : {viewOf(cloud.xyz), of_three}) {
      const SheetEdges edges(points, fieldOf(sheets));
      const std::vector<std::uint32_t> listed = edges.list(table, 0);
      std::size_t joined = 0;
      std::size_t apart = 0;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        for (int j = 1; j < std::min(table.count(i), kSheetDegree + 1); ++j) {
          const bool join = edges.join(i, static_cast<std::size_t>(table.indices(i)[j]));
          ASSERT_EQ((listed[i] >> (j - 1) & 1U) != 0, join) << i << ", neighbour " << j;
          (join ? joined : apart) += 1;
        }
      }
      EXPECT_GT(joined, cloud.size());
      EXPECT_GT(apart, k > 3 ? cloud.size() / 10 : 0);
    }
  }
}

// The mean as it is defined, one neighbour after the other, in double; rows of different length,
// and points without a normal.
TEST(SheetFilter, IsTheWeightedMeanOfTheNormalsAround) {
  const LabelledCloud cloud = sample("cube", cube(), 2003, 9, 0.3);
  Neighborhoods table = neighborsOf(cloud.xyz);
  std::vector<float> oriented = cloud.normals;
  std::mt19937 random(10);
  std::normal_distribution<float> gauss(0.F, 0.2F);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    table.setCount(i, i % 100 == 1 ? 0 : 5 + static_cast<int>(random() % 29));
    float* n = &oriented[4 * i];
    for (std::size_t a = 0; a < 3; ++a) n[a] += gauss(random);
    const float length = std::sqrt(dot3(n, n));
    for (std::size_t a = 0; a < 3; ++a) n[a] /= length;
    n[3] = std::fabs(gauss(random));
    if (i % 50 == 0) std::fill(n, n + 4, std::numeric_limits<float>::quiet_NaN());
  }
  constexpr float kResidual = 0.15F;
  const auto h = static_cast<float>(cloud.spacing);
  const std::vector<float> spacing(cloud.size(), h);
  const PointView points = viewOf(cloud.xyz);
  const FilteredNormals filtered =
      filterOrientedNormals(points, table, oriented, spacing, kResidual, 1, false);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3d sum(0, 0, 0);
    double total = 0.0;
    for (int j = 0; j < table.count(i); ++j) {
      const auto q = static_cast<std::size_t>(table.indices(i)[j]);
      const Eigen::Vector3d n = Eigen::Vector3f(&oriented[4 * q]).cast<double>();
      if (!n.allFinite()) continue;
      const Eigen::Vector3d d =
          (Eigen::Vector3f(points[q]) - Eigen::Vector3f(points[i])).cast<double>() /
          static_cast<double>(h);
      const double residual = static_cast<double>(kResidual);
      const double off = d.dot(n) / std::sqrt(0.01 + residual * residual);
      const double fit = static_cast<double>(oriented[4 * q + 3]) / (0.03 + residual);
      const double w = std::pow(1.0 + off * off / 32.0, -16.0) / (1.0 + fit * fit) /
                       (1.0 + 0.25 * d.squaredNorm());
      sum += w * n;
      total += w;
    }
    if (table.count(i) == 0) {
      ASSERT_EQ(filtered.confidences[i], 0.F) << i;
      continue;
    }
    const Eigen::Vector3d expected = sum.normalized();
    for (int a = 0; a < 3; ++a) {
      ASSERT_NEAR(filtered.normals[4 * i + static_cast<std::size_t>(a)], expected[a], 2e-4) << i;
    }
    ASSERT_NEAR(filtered.confidences[i], sum.norm() / total, 1e-4) << i;
  }
}

}  // namespace
}  // namespace segorient::test
