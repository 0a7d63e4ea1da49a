// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Which of several places pieces of surface were seen from, and where that is not told.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/piece_origins.h"
#include "search/index_of.h"

namespace segorient {
namespace {

using Place = std::array<double, 3>;

// Of a piece at the origin.
struct Origin {
  std::int32_t place;
  bool either_side;
};
Origin originOf(const std::array<float, 3>& normal, const std::vector<Place>& places,
                const std::vector<float>& left) {
  const std::array<float, 3> center{0.F, 0.F, 0.F};
  detail::DensityPatches patches;
  patches.add(center.data(), normal.data(), 1.F);
  std::vector<std::vector<float>> rows;
  for (const float v : left) rows.push_back({v});
  const detail::PieceOrigins found = detail::strongestPlaces(patches, places, rows);
  return {found.place.at(0), found.either_side.at(0) != 0};
}

TEST(Shares, OneSideHasToLeaveFarMoreThanTheOther) {
  const std::array<float, 3> up{0.F, 0.F, 1.F};
  const std::vector<Place> two{{0.0, 0.0, 2.0}, {0.0, 0.0, -2.0}};
  EXPECT_EQ(originOf(up, two, {5.F, 1.F}).place, 0);
  EXPECT_FALSE(originOf(up, two, {5.F, 1.F}).either_side);
  EXPECT_EQ(originOf(up, two, {1.F, 5.F}).place, 1);
  EXPECT_FALSE(originOf(up, two, {1.F, 5.F}).either_side);
  EXPECT_EQ(originOf(up, two, {2.F, 1.F}).place, 0);
  EXPECT_TRUE(originOf(up, two, {2.F, 1.F}).either_side);
  EXPECT_TRUE(originOf(up, two, {1.F, 2.F}).either_side);
}

TEST(Shares, PlacesOnOneSideAddUp) {
  const std::array<float, 3> up{0.F, 0.F, 1.F};
  const std::vector<Place> places{{0.0, 0.0, -2.0}, {0.0, 0.0, 2.0}, {0.0, 0.0, 3.0}};
  const Origin two_over_one = originOf(up, places, {1.F, 0.9F, 0.95F});
  EXPECT_EQ(two_over_one.place, 2);
  EXPECT_TRUE(two_over_one.either_side);
  EXPECT_FALSE(originOf(up, places, {1.F, 3.F, 3.F}).either_side);
  EXPECT_FALSE(originOf(up, places, {0.F, 0.F, 1.F}).either_side);
}

// The law makes little of the scanner right below, as the piece stands edge-on to it.
TEST(Shares, APieceThatNoiseTiltedIsStillSeenFromWhoIsNear) {
  const std::array<float, 3> level{1.F, 0.F, 0.F};
  const std::vector<Place> below_and_beside{{-0.02, 0.0, -1.0}, {3.0, 0.0, -1.0}};
  EXPECT_FALSE(originOf(level, below_and_beside, {0.03F, 0.095F}).either_side);
  EXPECT_TRUE(originOf(level, below_and_beside, {0.03F, 0.95F}).either_side);
}

// A level grid of 60 by 60 points.
std::vector<float> grid() {
  std::vector<float> rows;
  for (int x = 0; x < 60; ++x) {
    for (int y = 0; y < 60; ++y) {
      rows.insert(rows.end(), {0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y), 0.F});
    }
  }
  return rows;
}

detail::KnownSensors know(const std::vector<float>& rows, const PointHints& hints) {
  const PointView points{rows.data(), 3, rows.size() / 3};
  Neighborhoods table;
  search::indexOf(points, 0).nearestKAll(33, table, false);
  const std::vector<float> spacing(points.size, 0.1F);
  return detail::findKnownSensors(points, table, spacing.data(), hints, 0);
}

TEST(Shares, WhatEitherSideMayHaveSeenIsNotTold) {
  const std::vector<float> rows = grid();
  const std::size_t n = rows.size() / 3;
  PointHints hints;
  for (std::size_t i = 0; i < n; ++i) {
    hints.sensors.insert(hints.sensors.end(), {i < n / 2 ? 1.F : 5.F, 3.F, 4.F});
  }
  EXPECT_EQ(know(rows, hints).scans[0].seen, n / 2);
  hints.either_side.assign(n, 0);
  for (std::size_t i = 0; i < n; i += 4) hints.either_side[i] = 1;
  const detail::KnownSensors known = know(rows, hints);
  ASSERT_EQ(known.scans.size(), 2U);
  EXPECT_EQ(known.scans[0].points, n / 2);
  EXPECT_EQ(known.scans[0].seen + known.scans[1].seen, n - n / 4);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(known.of(i)[2] > 0.F, i % 4 != 0) << i;
    EXPECT_EQ(known.of(i)[2] == 0.F, i % 4 == 0) << i;
  }
}

// Places that were found by chance contradict themselves most where either side may have seen.
TEST(Shares, WhatIsNotToldIsEvidenceAgainstPlacesAllTheSame) {
  const std::vector<float> rows = grid();
  const std::size_t n = rows.size() / 3;
  PointHints hints;
  hints.either_side.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const bool from_below = i % 7 == 0;
    hints.sensors.insert(hints.sensors.end(), {3.F, 3.F, from_below ? -4.F : 4.F});
    if (from_below) hints.either_side[i] = 1;
  }
  EXPECT_TRUE(detail::seeBothSides(know(rows, hints).scans));
}

// Of a cloud whose neighbours nobody has looked for, too.
TEST(Shares, SensorsThatSeeASheetFromBothSidesAreTold) {
  const std::vector<float> rows = grid();
  for (const float below : {4.F, -4.F}) {
    PreparedCloud cloud({rows.data(), 3, rows.size() / 3}, nullptr, 0);
    PointHints hints;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      hints.sensors.insert(hints.sensors.end(), {1.F, 1.F, i % 7 == 0 ? below : 4.F});
    }
    EXPECT_EQ(detail::seeBothSides(cloud, hints, 0), below < 0.F);
  }
}

// A lower sheet that the upper one hides from both places.
TEST(Shares, PlacesAlongAWayAreNotDeniedByWhatTheyHide) {
  std::vector<float> rows = grid();
  const std::size_t upper = rows.size();
  for (std::size_t i = 0; i < upper; i += 3) {
    if (rows[i] > 2.F && rows[i] < 4.F) {
      rows.insert(rows.end(), {rows[i] + 0.03F, rows[i + 1] + 0.02F, -0.8F});
    }
  }
  PointHints hints;
  for (std::size_t i = 0; i < rows.size() / 3; ++i) {
    hints.sensors.insert(hints.sensors.end(), {rows[3 * i] < 3.F ? 2.5F : 3.5F, 3.F, 4.F});
  }
  const detail::KnownSensors given = know(rows, hints);
  hints.place.along_way = true;
  const detail::KnownSensors found = know(rows, hints);
  ASSERT_EQ(given.scans.size(), 2U);
  ASSERT_EQ(found.scans.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_GT(given.scans[s].hidden, 0.1F);
    EXPECT_FALSE(given.scans[s].used);
    EXPECT_EQ(found.scans[s].hidden, given.scans[s].hidden);
    EXPECT_TRUE(found.scans[s].used);
  }
}

}  // namespace
}  // namespace segorient
