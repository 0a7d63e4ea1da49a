// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Patches that the field of all points shows to be the wrong way, told from those that it only
// hardly minds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/field_patches.h"
#include "orientation/automatic/noise_field.h"
#include "sheet_fixture.h"

namespace segorient::test {
namespace {

constexpr int kSide = 40;
constexpr float kRadius = 2.F;

// The two faces of a plate, a unit between points, normals outward.
struct Plate {
  detail::EvenCells cells;

  explicit Plate(float thickness) {
    for (const float side : {-1.F, 1.F}) {
      for (int i = 0; i < kSide * kSide; ++i) {
        const auto x = static_cast<float>(i % kSide);
        const auto y = static_cast<float>(i / kSide);
        for (const float v : {x, y, 0.5F * side * thickness, 0.F}) cells.places.push_back(v);
        for (const float v : {0.F, 0.F, side, 0.F}) cells.normals.push_back(v);
        cells.areas.push_back(1.F);
      }
    }
    detail::assignCells(cells.points(), 1, cells);
  }
  FieldSolver solver() const {
    return FieldSolver(cells.points(), cells.around, cells.areas, kRadius, 1);
  }
  // Of the upper face, a square around its middle.
  std::vector<std::uint32_t> middle(float reach) const {
    std::vector<std::uint32_t> out;
    for (std::size_t c = cells.size() / 2; c < cells.size(); ++c) {
      const float* p = cells.points()[c];
      if (std::max(std::fabs(p[0] - 20.F), std::fabs(p[1] - 20.F)) > reach) continue;
      out.push_back(static_cast<std::uint32_t>(c));
    }
    return out;
  }
  std::vector<float> turned(const std::vector<std::uint32_t>& rows) const {
    std::vector<float> normals = cells.normals;
    for (const std::uint32_t c : rows) normals[4 * std::size_t{c} + 2] *= -1.F;
    return normals;
  }
  std::vector<std::uint8_t> takeBetter(const std::vector<float>& other,
                                       std::vector<float>& normals) const {
    const FieldSolver solver = this->solver();
    const float factor = solver.fit(normals).factor;
    return detail::takeBetterPatches(solver, cells, factor, solver.lackOf(normals, factor), other,
                                     normals);
  }
  bool contradicts(const std::vector<float>& normals) const {
    return detail::contradictsField(solver().lackOf(normals, solver().fit(cells.normals).factor));
  }
};

TEST(FieldPatches, MeansOfAPatchAreItsPartOfAllMeans) {
  const Plate plate(4.F);
  const std::vector<std::uint32_t> rows = plate.middle(6.F);
  std::vector<std::uint32_t> all;
  for (std::uint32_t c = 0; c < plate.cells.size(); ++c) all.push_back(c);
  const std::vector<float> with = plate.solver().lackOf(plate.cells.normals, 1.F);
  std::vector<float> rest = plate.cells.normals;
  for (const std::uint32_t c : rows) rest[4 * std::size_t{c} + 2] = 0.F;
  const std::vector<float> without = plate.solver().lackOf(rest, 1.F);
  const std::vector<float> means = plate.solver().meansNear(plate.cells.normals, rows, all);
  for (std::size_t c = 0; c < all.size(); ++c) {
    EXPECT_NEAR(means[c], without[c] - with[c], 0.01F) << c;
  }
  const std::vector<float> near = plate.solver().meansNear(plate.cells.normals, rows, rows);
  EXPECT_EQ(near[0], 0.F);
  EXPECT_NEAR(near[plate.middle(0.F)[0]], means[plate.middle(0.F)[0]], 0.01F);
}

TEST(FieldPatches, OneSideOfAThinPartIsTakenFromTheOtherSolution) {
  const Plate plate(3.F);
  const std::vector<std::uint32_t> wrong = plate.middle(8.F);
  std::vector<float> normals = plate.turned(wrong);
  EXPECT_TRUE(plate.contradicts(normals));
  const std::vector<std::uint8_t> taken = plate.takeBetter(plate.cells.normals, normals);
  EXPECT_EQ(normals, plate.cells.normals);
  ASSERT_EQ(taken.size(), plate.cells.size());
  EXPECT_EQ(std::count(taken.begin(), taken.end(), 1), static_cast<std::ptrdiff_t>(wrong.size()));
  for (const std::uint32_t c : wrong) EXPECT_EQ(taken[c], 1) << c;
}

TEST(FieldPatches, TheOtherSolutionIsNotTakenWhereItIsWorse) {
  const Plate plate(3.F);
  EXPECT_FALSE(plate.contradicts(plate.cells.normals));
  std::vector<float> normals = plate.cells.normals;
  const std::vector<std::uint8_t> taken =
      plate.takeBetter(plate.turned(plate.middle(8.F)), normals);
  EXPECT_TRUE(taken.empty());
  EXPECT_EQ(normals, plate.cells.normals);
}

// As many cells as a mean of the field is of.
TEST(FieldPatches, AHandfulOfCellsContradictsNothing) {
  std::vector<float> lack(1000, 0.49F);
  std::fill_n(lack.begin(), 24, -0.51F);
  EXPECT_FALSE(detail::contradictsField(lack));
  lack[24] = 0.51F;
  EXPECT_TRUE(detail::contradictsField(lack));
}

// A sheet whose field falls the other way in its middle keeps it, unless it is known that it was
// wrong; so do parts of the cloud.
TEST(FieldPatches, WhatIsSurelyWrongMayTearASheet) {
  const Plate plate(100.F);  // its faces have nothing to do with each other
  const std::vector<std::uint32_t> inner = plate.middle(8.F);
  detail::NoiseField field;
  field.places = plate.cells.places;
  field.dipoles = plate.turned(inner);
  for (std::size_t i = 3; i < field.dipoles.size(); i += 4) field.dipoles[i] = 1.F;
  field.radius = 1.5F;
  field.factor = 1.F;
  field.consistent = true;
  const auto turnedBy = [&](const detail::NoiseField& by) {
    detail::AutoNormals found;
    found.normals = plate.cells.normals;
    found.confidences.assign(plate.cells.size(), 1.F);
    detail::takeNoiseField(plate.cells.points(), plate.cells.around, by, 1, found);
    std::size_t count = 0;
    for (const std::uint32_t c : inner) count += found.normals[4 * std::size_t{c} + 2] < 0.F;
    return count;
  };
  EXPECT_EQ(turnedBy(field), 0U);
  field.turns.assign(plate.cells.size(), 0);
  for (const std::uint32_t c : inner) field.turns[c] = 1;
  const std::size_t turned = turnedBy(field);  // not at the corners, where it hardly falls
  EXPECT_GT(10 * turned, 9 * inner.size());
  detail::findWhatSheetsKeep(plate.cells.points(), plate.cells.around, plate.cells.normals, 1,
                             field);
  for (const std::uint32_t c : inner) EXPECT_EQ(field.keeps[c], 0) << c;
  EXPECT_EQ(turnedBy(field), turned);
}

}  // namespace
}  // namespace segorient::test
