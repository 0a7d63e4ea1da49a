// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The final filter where two faces meet at a narrow angle.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <random>

#include "orientation/automatic/sheet_filter.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

/// Two faces at 30 degrees that look away from each other.
struct Wedge {
  static constexpr float kHalf = 0.2617994F;  // 15 degrees
  static constexpr float kSpacing = 0.0155F;  // 0.977 of the side of one point's square

  std::vector<float> xyz;
  std::vector<float> truth;
  std::vector<float> oriented;

  /// \param start normal to begin with, of a point: its side, its distance from the edge, its place
  ///        along it; as a factor of the true one and one of the other face's
  explicit Wedge(const std::function<std::array<float, 2>(float, float, float)>& start) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.F, 1.F);
    for (int i = 0; i < 8000; ++i) {
      const float side = i % 2 == 0 ? 1.F : -1.F;
      const float d = unit(random);
      const float z = unit(random);
      const auto [own, other] = start(side, d, z);
      const std::array<float, 2> n{-std::sin(kHalf), side * std::cos(kHalf)};
      xyz.insert(xyz.end(), {d * std::cos(kHalf), side * d * std::sin(kHalf), z, 0.F});
      truth.insert(truth.end(), {n[0], n[1], 0.F, 0.F});
      const std::array<float, 2> mean{(own + other) * n[0], (own - other) * n[1]};
      const float length = std::hypot(mean[0], mean[1]);
      // Planes through points of both faces leave a part of their distance.
      const float residual = own * other != 0.F ? 0.3F : 0.F;
      oriented.insert(oriented.end(), {mean[0] / length, mean[1] / length, 0.F, residual});
    }
  }

  double shareRight(bool wedges, float residual = 0.F) const {
    const std::vector<float> spacing(xyz.size() / 4, kSpacing);
    const FilteredNormals filtered = filterOrientedNormals(viewOf(xyz), neighborsOf(xyz), oriented,
                                                           spacing, residual, 2, wedges);
    return shareOutward(filtered.normals, truth);
  }
};

// What stays wrong lies on both planes within hundredths of a spacing.
TEST(Wedges, PointsTakeTheNormalOfTheirFace) {
  const Wedge wedge([](float side, float d, float) -> std::array<float, 2> {
    if (d < 1.5F * Wedge::kSpacing && side > 0.F) return {0.F, 1.F};
    return {1.F, 0.F};
  });
  EXPECT_LT(shareOutward(wedge.oriented, wedge.truth), 0.995);
  EXPECT_GT(wedge.shareRight(true), 0.9985);
  EXPECT_LT(wedge.shareRight(false), 0.9985);
}

// Deep in the wedge, where planes took points of both faces, no neighbour's normal is sure until
// those farther out have got theirs.
TEST(Wedges, FromOutsideInwards) {
  const Wedge wedge([](float, float d, float z) -> std::array<float, 2> {
    const float own = std::fmod(1000.F * (d + z), 2.F) < 1.F ? 0.7F : 0.3F;
    if (d < 6.F * Wedge::kSpacing) return {own, 1.F - own};
    return {1.F, 0.F};
  });
  const auto shareOfTheirFace = [&](const std::vector<float>& normals) {
    std::size_t near = 0;
    for (std::size_t i = 0; i < normals.size(); i += 4) {
      near += dot3(&normals[i], &wedge.truth[i]) > 0.95F ? 1 : 0;
    }
    return 4.0 * static_cast<double>(near) / static_cast<double>(normals.size());
  };
  EXPECT_LT(shareOfTheirFace(wedge.oriented), 0.92);
  const std::vector<float> spacing(wedge.xyz.size() / 4, Wedge::kSpacing);
  const FilteredNormals filtered = filterOrientedNormals(viewOf(wedge.xyz), neighborsOf(wedge.xyz),
                                                         wedge.oriented, spacing, 0.F, 2, true);
  // In one go it would be 0.9583.
  EXPECT_GT(shareOfTheirFace(filtered.normals), 0.9595);
}

TEST(Wedges, PatchesWithTheSignOfTheOtherFaceAreTurned) {
  const Wedge wedge([](float side, float d, float z) -> std::array<float, 2> {
    const bool patch = d < 6.F * Wedge::kSpacing && std::fabs(z - 0.5F) < 0.1F;
    return {patch && side > 0.F ? -1.F : 1.F, 0.F};
  });
  EXPECT_LT(shareOutward(wedge.oriented, wedge.truth), 0.995);
  EXPECT_LT(wedge.shareRight(false), 0.995);
  EXPECT_GT(wedge.shareRight(true), 0.9985);
  // Not where noise may have mixed the faces.
  EXPECT_LT(wedge.shareRight(true, 0.2F), 0.995);
}

// Which of two large patches is right cannot be told from where they meet.
TEST(Wedges, LargePatchesStay) {
  const Wedge wedge([](float side, float, float z) -> std::array<float, 2> {
    return {side > 0.F && z < 0.4F ? -1.F : 1.F, 0.F};
  });
  const double before = shareOutward(wedge.oriented, wedge.truth);
  EXPECT_NEAR(wedge.shareRight(true), before, 0.01);
}

// Points that lie closer together than a float can invert.
TEST(Wedges, SpacingsWithoutAnInverse) {
  const Wedge wedge([](float, float, float) -> std::array<float, 2> { return {1.F, 0.F}; });
  const std::vector<float> spacing(wedge.xyz.size() / 4, 1e-40F);
  const FilteredNormals filtered = filterOrientedNormals(viewOf(wedge.xyz), neighborsOf(wedge.xyz),
                                                         wedge.oriented, spacing, 0.F, 2, true);
  for (std::size_t i = 0; i < filtered.normals.size(); i += 4) {
    ASSERT_NEAR(dot3(&filtered.normals[i], &filtered.normals[i]), 1.F, 1e-4F) << i / 4;
  }
}

TEST(Wedges, SameBitsForAnyInstructionSet) {
  const Wedge wedge([](float, float d, float) -> std::array<float, 2> { return {1.F, 0.3F * d}; });
  const std::vector<float> spacing(wedge.xyz.size() / 4, Wedge::kSpacing);
  const auto filtered = [&] {
    return filterOrientedNormals(viewOf(wedge.xyz), neighborsOf(wedge.xyz), wedge.oriented, spacing,
                                 0.1F, 2, true);
  };
  const FilteredNormals reference = filtered();
  setenv("SEGORIENT_SIMD", "sse2", 1);
  const FilteredNormals narrow = filtered();
  unsetenv("SEGORIENT_SIMD");
  EXPECT_EQ(narrow.normals, reference.normals);
  EXPECT_EQ(narrow.confidences, reference.confidences);
}

TEST(Wedges, WallsOfAThinPlateAreTwoSurfaces) {
  const LabelledCloud cloud = sample("plate", plate(1, 8000), 8000, 4);
  const std::vector<float> spacing(cloud.size(), static_cast<float>(cloud.spacing));
  for (const bool wedges : {false, true}) {
    const FilteredNormals filtered = filterOrientedNormals(
        viewOf(cloud.xyz), neighborsOf(cloud.xyz), cloud.normals, spacing, 0.F, 2, wedges);
    EXPECT_GT(shareOutward(filtered.normals, cloud.normals), 0.999) << wedges;
  }
}

}  // namespace
}  // namespace segorient::test
