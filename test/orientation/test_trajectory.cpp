// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Where a moving sensor was, by time.
#include <gtest/gtest.h>
#include <segorient/orientation/trajectory.h>

#include <cmath>
#include <limits>

namespace segorient::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Trajectory line() {
  return Trajectory({{20.0, {10.0, 0.0, 1.0}},
                     {10.0, {0.0, 0.0, 0.0}},
                     {kNaN, {5.0, 5.0, 5.0}},
                     {30.0, {10.0, kNaN, 1.0}},
                     {20.0, {99.0, 0.0, 0.0}}});
}

TEST(Trajectory, IsLinearBetweenPosesAndEndsWithThem) {
  const Trajectory trajectory = line();
  ASSERT_EQ(trajectory.size(), 2U) << "what is no number is left out, of one time the first stays";
  std::array<double, 3> p{};
  ASSERT_TRUE(trajectory.at(12.5, p));
  EXPECT_DOUBLE_EQ(p[0], 2.5);
  EXPECT_DOUBLE_EQ(p[2], 0.25);
  EXPECT_TRUE(trajectory.at(10.0, p));
  EXPECT_TRUE(trajectory.at(20.0, p));
  EXPECT_EQ(p[0], 10.0);
  EXPECT_FALSE(trajectory.at(9.999, p));
  EXPECT_FALSE(trajectory.at(20.001, p));
  EXPECT_FALSE(trajectory.at(kNaN, p));
  EXPECT_FALSE(Trajectory().at(0.0, p));
}

TEST(Trajectory, JoinSaysWhatIsOutside) {
  const TrajectoryJoin join = joinTrajectory(line(), {15.0, 5.0, kNaN, 20.0, 25.0});
  EXPECT_EQ(join.joined, 2U);
  EXPECT_EQ(join.outside, 2U);
  EXPECT_EQ(join.without_time, 1U);
  EXPECT_EQ(join.first_time, 5.0);
  EXPECT_EQ(join.last_time, 25.0);
  EXPECT_DOUBLE_EQ(join.viewpoints[0], 5.0);
  EXPECT_TRUE(std::isnan(join.viewpoints[3]));
  EXPECT_TRUE(std::isnan(join.viewpoints[6]));
  EXPECT_DOUBLE_EQ(join.viewpoints[9], 10.0);
}

// Points measured from 300,000,000 s of GPS standard time on.
TEST(Trajectory, TimeBasesAreRecognised) {
  struct Case {
    double poses;
    double points;
    const char* text;
  };
  constexpr double kStandard = 1.3e9;
  const Case cases[] = {
      {kStandard, kStandard - 1e9, "points' times are GPS time less 1e9"},
      {kStandard - 1e9, kStandard, "trajectory's times are GPS time less 1e9"},
      {kStandard + 315964800.0, kStandard, "the trajectory's Unix time"},
      {1000.0, 1000.0 * 1e9, "nanoseconds"},
      {kStandard, std::fmod(kStandard, 604800.0), "points' times are seconds of the"},
      {std::fmod(kStandard, 604800.0), kStandard - 1e9, "trajectory's times are seconds of the"}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const Trajectory trajectory({{c.poses - 50.0, {0, 0, 0}}, {c.poses + 50.0, {1, 1, 1}}});
    const TrajectoryJoin join = joinTrajectory(trajectory, {c.points, c.points + 1.0});
    EXPECT_EQ(join.joined, 0U);
    EXPECT_NE(explainNoOverlap(trajectory, join).find(c.text), std::string::npos)
        << explainNoOverlap(trajectory, join);
  }
  const Trajectory other({{500.0, {0, 0, 0}}, {600.0, {1, 1, 1}}});
  EXPECT_EQ(
      explainNoOverlap(other, joinTrajectory(other, {0.0, 100.0})),
      "no point was measured within the trajectory's time: points 0 to 100, trajectory 500 to "
      "600");
}

}  // namespace
}  // namespace segorient::test
