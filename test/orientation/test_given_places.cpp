// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Places that are given for some points only, mixed up, moved, or those of nobody: never worse than
// none at all.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "common/at.h"
#include "orientation/automatic/sensor_signs.h"
#include "orientation/sensors/given_places.h"
#include "orientation/sensors/number_places.h"
#include "scanned_boxes.h"

namespace segorient::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::size_t notFollowed(const OrientedCloud& cloud) {
  return static_cast<std::size_t>(std::count_if(cloud.report.known_sensors.begin(),
                                                cloud.report.known_sensors.end(),
                                                [](const KnownSensor& s) { return !s.used; }));
}

class GivenPlaces : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    around_ = new Around;
    free_ = shareOutward(orient(around_->scans.xyz, {}).normals, around_->scans.normals);
  }
  static void TearDownTestSuite() {
    delete around_;
    around_ = nullptr;
  }
  static OrientedCloud oriented(const std::array<int, 4>& of_scan) {
    return orient(around_->scans.xyz, around_->withPoses(of_scan));
  }
  static double share(const OrientedCloud& cloud) {
    return shareOutward(cloud.normals, around_->scans.normals);
  }

  static Around* around_;
  static double free_;
};

Around* GivenPlaces::around_ = nullptr;
double GivenPlaces::free_ = 0.0;

TEST_F(GivenPlaces, OneScanThatIsKnownLeavesTheOthersAsTheyAreWithoutIt) {
  ASSERT_GE(free_, 0.998);
  for (const auto& known : {std::array{0, -1, -1, -1}, std::array{-1, -1, 2, -1}}) {
    const OrientedCloud cloud = oriented(known);
    EXPECT_GE(share(cloud), free_ - 0.001);
    EXPECT_EQ(notFollowed(cloud), 0U);
  }
}

TEST_F(GivenPlaces, AllPosesMixedUpCostNothing) {
  for (const auto& mixed :
       {std::array{1, 2, 3, 0}, std::array{3, 2, 1, 0}, std::array{1, 0, 2, 3}}) {
    const OrientedCloud cloud = oriented(mixed);
    EXPECT_GE(share(cloud), free_ - 0.001);
    EXPECT_GE(notFollowed(cloud), 2U);
  }
}

// Nothing contradicts them but densities and shadows.
TEST_F(GivenPlaces, PlacesThatAreMovedTogetherCostNothing) {
  for (const Vector& by : {Vector{0, 0, -9}, Vector{0, 4, 0}}) {
    OrientationHints hints = eachItsOwn(around_->scans);
    for (std::size_t i = 0; i < hints.viewpoints.size(); ++i) {
      hints.viewpoints[i] += static_cast<float>(by[i % 3]);
    }
    EXPECT_GE(share(orient(around_->scans.xyz, hints)), free_ - 0.002) << by[1];
  }
}

TEST_F(GivenPlaces, ScansThatShareAPlaceAreReportedEachByItself) {
  OrientationHints hints = around_->withPoses({1, 1, 2, 3});
  hints.scans.assign(around_->scans.scan.begin(), around_->scans.scan.end());
  const OrientedCloud cloud = orient(around_->scans.xyz, hints);
  EXPECT_GE(share(cloud), free_ - 0.001);
  std::vector<std::int32_t> refused;
  for (const KnownSensor& s : cloud.report.known_sensors) {
    if (!s.used) refused.push_back(s.scan);
  }
  EXPECT_EQ(refused, std::vector<std::int32_t>{0});
}

TEST(GivenPlacesOfNobody, ThePointsThemselvesSayNoMoreThanNone) {
  const Scans scans = room({1.1, 0.9, 1.4});
  OrientationHints hints;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    hints.viewpoints.insert(hints.viewpoints.end(), &scans.xyz[4 * i], &scans.xyz[4 * i] + 3);
  }
  EXPECT_EQ(orient(scans.xyz, hints).normals, orient(scans.xyz, {}).normals);
}

// Places that stand only in rows without a point, here rows that are not asked for.
TEST(GivenPlacesOfNobody, RowsWithoutAPointSayNothing) {
  const Scans scans = room({1.1, 0.9, 1.4});
  OrientationHints hints = eachItsOwn(scans);
  pcl::Indices rows;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i < scans.size() / 2) {
      rows.push_back(static_cast<pcl::index_t>(i));
      hints.viewpoints[3 * i] = kNaN;
    }
  }
  PipelineOptions options;
  const OrientedCloud none = orientCloud(viewOf(scans.xyz), &rows, options);
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  const OrientedCloud cloud = orientCloud(viewOf(scans.xyz), &rows, options);
  ASSERT_EQ(cloud.normals.size(), none.normals.size());
  for (std::size_t i = 0; i < 2 * scans.size(); ++i) ASSERT_EQ(cloud.normals[i], none.normals[i]);
}

TEST(GivenPlacesOfNobody, ARoomIsNotSeenFromAbove) {
  const Scans scans = room({1.1, 0.9, 1.4});
  OrientationHints up;
  up.has_direction = true;
  const OrientedCloud cloud = orient(scans.xyz, up);
  EXPECT_GE(shareOutward(cloud.normals, scans.normals), 0.998);
  EXPECT_EQ(notFollowed(cloud), 1U);
}

TEST(GivenPlacesOfNobody, WhatIsSeenEdgeOnKeepsTheSideOfConvention) {
  std::vector<float> xyz;
  for (int i = 0; i < 900; ++i) {
    xyz.insert(xyz.end(), {static_cast<float>(i / 30), static_cast<float>(i % 30), 0.F, 0.F});
  }
  OrientationHints hints;
  hints.has_viewpoint = true;
  hints.viewpoint = {200.F, 30.F, 0.F};
  const OrientedCloud cloud = orient(xyz, hints);
  for (std::size_t i = 0; i < 900; ++i) ASSERT_GT(cloud.normals[4 * i + 2], 0.F) << i;
}

TEST(NumberedScans, OnlyLargePartsOfSeveralPlacesAreSplitOff) {
  using Places = std::vector<std::array<float, 3>>;
  // Place 0 has scans 4 (three points), 7 (three) and 8 (one); place 1 scan 5.
  const std::vector<std::int32_t> scans{4, 7, 4, 8, 7, 4, 7, 5, 5, -1};
  const std::vector<std::int32_t> of{0, 0, 0, 0, 0, 0, 0, 1, 1, -1};
  Places places{{0.F, 0.F, 0.F}, {1.F, 0.F, 0.F}};
  std::vector<std::int32_t> split = of;
  EXPECT_EQ(detail::splitByScan(scans, 3, places, split), (std::vector<std::int32_t>{-1, 5, 7}));
  EXPECT_EQ(split, (std::vector<std::int32_t>{0, 2, 0, 0, 2, 0, 2, 1, 1, -1}));
  EXPECT_EQ(places, (Places{{0.F, 0.F, 0.F}, {1.F, 0.F, 0.F}, {0.F, 0.F, 0.F}}));
  // All from one place stay together, and are of one scan if all agree.
  Places one{{0.F, 0.F, 0.F}};
  std::vector<std::int32_t> same{0, 0, -1};
  EXPECT_EQ(detail::splitByScan({6, 6, 2}, 1, one, same), std::vector<std::int32_t>{6});
  EXPECT_EQ(detail::splitByScan({6, 3, 2}, 1, one, same), std::vector<std::int32_t>{-1});
  EXPECT_EQ(detail::splitByScan({}, 1, one, same), std::vector<std::int32_t>{-1});
  EXPECT_EQ(one.size(), 1U);
}

KnownSensor scanOf(std::size_t points, bool used, float density) {
  KnownSensor out;
  out.points = points;
  out.seen = used ? points : 0;
  out.used = used;
  out.density = density;
  return out;
}

// 100 points in a plane, the first half scan 0, the others scan 1.
struct Square {
  std::vector<float> xyz;
  PreparedCloud cloud;
  detail::SeenPoints seen;
  OrientationHints given;
  OrientationHints found;
  std::vector<std::uint8_t> either_side;

  Square() {
    for (int i = 0; i < 100; ++i) {
      xyz.insert(xyz.end(), {static_cast<float>(i / 10), static_cast<float>(i % 10), 0.F, 0.F});
      given.viewpoints.insert(given.viewpoints.end(), {5.F, 5.F, 20.F});
      found.viewpoints.insert(found.viewpoints.end(), {5.F, 5.F, 20.F});
    }
    cloud = PreparedCloud(viewOf(xyz), nullptr, 1);
    for (std::size_t p = 0; p < cloud.size(); ++p) {
      seen.sensor_of.push_back(cloud.rowOf(p) < 50 ? 0 : 1);
      seen.toward.insert(seen.toward.end(), {0.F, 0.F, 1.F});
    }
  }
  std::optional<OrientationHints> completed(std::vector<KnownSensor>& scans) const {
    return detail::completePlaces(given, found, either_side, cloud, seen, scans);
  }
  void forget(std::size_t row) {
    for (std::size_t p = 0; p < cloud.size(); ++p) {
      if (cloud.rowOf(p) == row) seen.sensor_of[p] = -1;
    }
  }
  void setFound(std::size_t row, float z) { found.viewpoints[3 * row + 2] = z; }
};

TEST(CompletedPlaces, DoubtIsLeftByWhatNothingConfirmsOrTells) {
  const Square square;
  EXPECT_FALSE(detail::leavesDoubt({scanOf(50, true, 0.2F), scanOf(50, true, 0.6F)}, square.cloud));
  EXPECT_FALSE(detail::leavesDoubt({scanOf(99, true, 0.2F)}, square.cloud));
  EXPECT_TRUE(detail::leavesDoubt({scanOf(98, true, 0.2F)}, square.cloud));
  EXPECT_TRUE(detail::leavesDoubt({scanOf(50, true, 0.2F), scanOf(50, true, 0.9F)}, square.cloud));
  EXPECT_TRUE(detail::leavesDoubt({scanOf(50, true, 0.2F), scanOf(50, false, 0.2F)}, square.cloud));
  KnownSensor moving = scanOf(100, true, kNaN);
  moving.moving = true;
  EXPECT_FALSE(detail::leavesDoubt({moving}, square.cloud));
}

TEST(CompletedPlaces, RowsWithoutOneTakeWhatWasFound) {
  Square square;
  std::vector<KnownSensor> scans{scanOf(50, true, 0.2F), scanOf(49, true, 0.2F)};
  square.setFound(10, -30.F);  // has its own
  EXPECT_FALSE(square.completed(scans));
  square.given.viewpoints[3 * 70] = kNaN;
  square.setFound(70, 30.F);
  square.forget(70);
  const auto done = square.completed(scans);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->viewpoints[3 * 70 + 2], 30.F);
  EXPECT_EQ(done->viewpoints[3 * 10 + 2], 20.F);
}

TEST(CompletedPlaces, WhatOnesOnEitherSideMayHaveSeenTakesNone) {
  Square square;
  std::vector<KnownSensor> scans{scanOf(50, true, 0.2F), scanOf(48, true, 0.2F)};
  square.either_side.assign(square.cloud.size(), 0);
  for (const std::size_t row : {70, 80}) {
    square.given.viewpoints[3 * row] = kNaN;
    square.forget(row);
  }
  square.either_side[at(square.cloud.pointOf(80))] = 1;
  const auto done = square.completed(scans);
  ASSERT_TRUE(done);
  EXPECT_EQ(done->viewpoints[3 * 70], 5.F);
  EXPECT_TRUE(std::isnan(done->viewpoints[3 * 80]));
}

TEST(CompletedPlaces, WhatIsFoundElsewhereForMostOfAScanTakesThePlaceOfWhatNothingConfirms) {
  for (const float density : {0.2F, 0.9F}) {
    for (const std::size_t elsewhere : {20U, 30U}) {
      Square square;
      for (std::size_t row = 0; row < elsewhere; ++row) square.setFound(row, -20.F);
      std::vector<KnownSensor> scans{scanOf(50, true, density), scanOf(50, true, 0.2F)};
      const auto done = square.completed(scans);
      const bool replaced = density > 0.7F && elsewhere > 25;
      EXPECT_EQ(done.has_value(), replaced);
      EXPECT_EQ(scans[0].used, !replaced);
      EXPECT_TRUE(scans[1].used);
    }
  }
}

TEST(CompletedPlaces, OfPosesThatWereMixedUpNoneIsBelievedAgainstWhatIsFound) {
  Square square;
  for (std::size_t row = 0; row < 50; ++row) square.setFound(row, -20.F);
  std::vector<KnownSensor> scans{scanOf(50, true, 0.2F), scanOf(50, false, 3.F)};
  const auto done = square.completed(scans);
  ASSERT_TRUE(done);
  EXPECT_FALSE(scans[0].used);
  EXPECT_EQ(done->viewpoints, square.found.viewpoints);
}

// A chain of segments: the first is decided, borders between them agree or not, surely or hardly.
TEST(TurnToSensors, TheSurestBorderDecidesFirst) {
  const auto border = [](std::int32_t a, std::int32_t b, float weight, float absolute) {
    BorderVote vote;
    vote.a = a;
    vote.b = b;
    vote.weight = weight;
    vote.absolute = absolute;
    return vote;
  };
  // Segment 2 touches the decided one by a border that hardly tells, and segment 1 surely.
  const std::vector<BorderVote> votes{border(0, 1, -9.F, 10.F), border(0, 2, -1.F, 10.F),
                                      border(1, 2, 20.F, 20.F), border(2, 3, -5.F, 5.F)};
  std::vector<detail::Ballot> ballots(5);
  ballots[0] = {100.F, 100.F};
  std::vector<std::int8_t> signs{-1, 1, 1, -1, 1};
  const std::vector<bool> decided = detail::turnToSensors(ballots, votes, true, signs);
  EXPECT_EQ(decided, (std::vector<bool>{true, false, false, false, false}));
  EXPECT_EQ(signs, (std::vector<std::int8_t>{1, -1, -1, 1, 1}));
  // Two borders to decided ones, 4 of 10 for +, 3 of 3 for -: what all say together decides.
  const std::vector<BorderVote> both{border(0, 2, 4.F, 10.F), border(1, 2, -3.F, 3.F)};
  std::vector<detail::Ballot> two(3);
  two[0] = two[1] = {100.F, 100.F};
  std::vector<std::int8_t> three{1, 1, -1};
  detail::turnToSensors(two, both, true, three);
  EXPECT_EQ(three[2], 1);
  // The segment's own points have a say, too.
  two[2] = {-2.F, 2.F};
  three = {1, 1, 1};
  detail::turnToSensors(two, both, true, three);
  EXPECT_EQ(three[2], -1);
}

}  // namespace
}  // namespace segorient::test
