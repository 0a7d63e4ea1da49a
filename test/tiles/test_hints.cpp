// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What is known beforehand, tile by tile; and when the program works so by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "run_program.h"
#include "sensor_scans.h"
#include "tile_clouds.h"
#include "tiles/plan_sensors.h"

namespace segorient::test {
namespace {

void expectRuns(std::vector<std::string> words) {
  words.insert(words.end(), {"-q", "--memory", "1G", "--tile-points", "700"});
  const Outcome run = runProgram(words);
  ASSERT_EQ(run.status, 0) << run.err;
}

// A sheet of 50 by 50 points in the plane z = 0, with more numbers a point.
std::vector<double> sheet(const std::vector<double>& more) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  std::vector<double> out;
  for (int i = 0; i < 2500; ++i) {
    out.insert(out.end(), {i % 50 + shift(random), i / 50 + shift(random), 0.0});
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

// \param most largest z of their normals
std::size_t facingDown(const std::string& path, double most = 0.0) {
  const program::CloudTable cloud = program::readCloud(path);
  std::size_t down = 0;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    down += cloud.triple(cloud.normals(), i)[2] < most ? 1 : 0;
  }
  return down;
}

class Hints : public testing::Test {
 protected:
  ScratchDirectory scratch;
  std::string out = scratch.file("out.ply");
};

// By itself, a sheet faces up.
TEST_F(Hints, SeedsTurnASheet) {
  const std::string in = writeDoubles(scratch.file("in.ply"), sheet({}));
  const std::string seeds =
      writeFields(scratch.file("seeds.ply"), {"x", "y", "z", "nx", "ny", "nz"},
                  {3.0, 4.0, 0.0, 0.0, 0.0, -1.0});
  expectRuns({"orient", in, out});
  EXPECT_EQ(facingDown(out), 0U);
  expectRuns({"orient", in, out, "--seeds", seeds});
  EXPECT_EQ(facingDown(out), 2500U);
}

// Normals of the lowest points that face up, as a share.
double shareUpAtTheBottom(const std::string& path) {
  const program::CloudTable cloud = program::readCloud(path);
  std::size_t bottom = 0;
  std::size_t up = 0;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    if (cloud.triple(cloud.xyz(), i)[2] > 0.0) continue;
    ++bottom;
    up += cloud.triple(cloud.normals(), i)[2] > 0.0 ? 1 : 0;
  }
  return static_cast<double>(up) / static_cast<double>(bottom);
}

// What the field of all points tells of touching bodies, their outside, is not what a seed says.
TEST_F(Hints, ASeedOnTouchingBodiesIsHeededAsInMemory) {
  const std::vector<double> xyz = stackOfBoxes(4, 2000);
  const std::string in = writeDoubles(scratch.file("in.ply"), xyz);
  const std::string whole = scratch.file("whole.ply");
  for (const double side : {-1.0, 1.0}) {
    const std::string seed =
        writeFields(scratch.file("seed.ply"), {"x", "y", "z", "nx", "ny", "nz"},
                    {0.3, 0.3, 0.0, 0.0, 0.0, side});
    ASSERT_EQ(runProgram({"orient", in, whole, "-q", "--seeds", seed}).status, 0);
    expectRuns({"orient", in, out, "--seeds", seed});
    const double up = shareUpAtTheBottom(whole);
    EXPECT_GT(side > 0.0 ? up : 1.0 - up, 0.99) << side;
    EXPECT_GE(sameSides(whole, out), xyz.size() / 3 - xyz.size() / 3000) << side;
  }
}

TEST_F(Hints, NormalsOfTheInputTurnASheet) {
  const std::string in = writeFields(scratch.file("in.ply"), {"x", "y", "z", "nx", "ny", "nz"},
                                     sheet({0.1, 0.0, -1.0}));
  expectRuns({"orient", in, out, "--keep-orientation"});
  EXPECT_EQ(facingDown(out), 2500U);
  const std::string without = writeDoubles(scratch.file("without.ply"), sheet({}));
  const Outcome run =
      runProgram({"orient", without, out, "-q", "--memory", "1G", "--keep-orientation"});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.err.find("has no normals"), std::string::npos) << run.err;
}

// Which sensors are to be believed, the whole knows: each tile is worked on again, and join says
// so.
TEST_F(Hints, JoinNamesTheTilesThatAreToBeDoneAgain) {
  const std::string in = writeDoubles(scratch.file("in.ply"), sheet({}));
  const std::string folder = scratch.file("work");
  const Outcome plan = runProgram({"tiles", "plan", folder, in, out, "--viewpoint=2,3,-9",
                                   "--memory", "1G", "--tile-points", "700"});
  ASSERT_EQ(plan.out, "tiles 4\noutputs 1\n") << plan.err;
  ASSERT_EQ(runProgram({"tiles", "tile", folder}).status, 0);
  for (int i = 0; i < 2; ++i) {
    const Outcome join = runProgram({"tiles", "join", folder});
    EXPECT_EQ(join.out, "again 0\nagain 1\nagain 2\nagain 3\n") << join.err;
  }
}

// A sensor that flew below, by the points' time.
TEST_F(Hints, ATrajectoryTurnsASheetAndIsWritten) {
  const std::string in =
      writeFields(scratch.file("in.ply"), {"x", "y", "z", "time"}, sheet({12.5}));
  const std::string path = scratch.write("path.txt", "10 0 25 -30\n20 50 25 -30\n");
  expectRuns({"orient", in, out, "--trajectory", path});
  EXPECT_EQ(facingDown(out, -0.9999), 2500U);
  const program::CloudTable cloud = program::readCloud(out);
  ASSERT_TRUE(cloud.hasViewpoints());
  EXPECT_DOUBLE_EQ(cloud.triple(cloud.viewpoints(), 17)[0], 12.5);
}

TEST_F(Hints, ATrajectoryOfAnotherTimeIsRefusedAsInMemory) {
  const std::string in =
      writeFields(scratch.file("in.ply"), {"x", "y", "z", "time"}, sheet({12.5}));
  const std::string path = scratch.write("path.txt", "100010 0 25 -30\n100020 50 25 -30\n");
  for (const bool by_tiles : {false, true}) {
    std::vector<std::string> words{"orient", in, out, "-q", "--trajectory", path};
    if (by_tiles) words.insert(words.end(), {"--memory", "1G", "--tile-points", "700"});
    const Outcome run = runProgram(words);
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.err.find("no point was measured within the trajectory's time"),
              std::string::npos);
  }
}

TEST_F(Hints, OneOutputOfSeveralInputsSaysWhichPointIsWhose) {
  std::vector<double> moved = sheet({});
  for (std::size_t i = 0; i < moved.size(); i += 3) moved[i] += 50.0;
  const std::string a = writeDoubles(scratch.file("a.ply"), sheet({}));
  const std::string b = writeDoubles(scratch.file("b.ply"), moved);
  const std::string report = scratch.file("report.json");
  expectRuns({"orient", a, b, out, "--report", report, "--beta", "25"});
  const program::CloudTable cloud = program::readCloud(out);
  const program::Field* scan = cloud.find("scan");
  ASSERT_NE(scan, nullptr);
  ASSERT_EQ(cloud.size, 5000U);
  EXPECT_EQ(cloud.value(*scan, 2499), 0.0);
  EXPECT_EQ(cloud.value(*scan, 2500), 1.0);
  EXPECT_NE(readFile(report).find("\"points\": 5000"), std::string::npos) << readFile(report);
}

// What does not fit in memory is worked on tile by tile without being asked for.
TEST_F(Hints, WhatDoesNotFitIsWorkedOnTileByTile) {
  const std::string in = writeDoubles(scratch.file("in.ply"), hollowSphere(12000, 0.0, 0.0, 0.0));
  const std::string whole = scratch.file("whole.ply");
  ASSERT_EQ(runProgram({"orient", in, whole, "-q"}).status, 0);
  const Outcome run = runProgram({"orient", in, out, "--available-memory", "2000000"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("tile by tile"), std::string::npos) << run.err;
  EXPECT_EQ(sameSides(whole, out), 12000U);
  const Outcome enough = runProgram({"orient", in, out, "--available-memory", "90000000"});
  EXPECT_EQ(enough.err.find("tile by tile"), std::string::npos) << enough.err;
}

// Points on the inside of a box.
std::vector<double> room(std::size_t n) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double half[3] = {3.0, 2.5, 1.3};
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) {
    double p[3];
    for (int a = 0; a < 3; ++a) p[a] = half[a] * uniform(random);
    const std::size_t wall = i % 6;
    p[wall / 2] = wall % 2 == 0 ? half[wall / 2] : -half[wall / 2];
    out.insert(out.end(), p, p + 3);
  }
  return out;
}

TEST_F(Hints, ARoomFacesItsSensorAsInMemory) {
  const std::string in = writeDoubles(scratch.file("in.ply"), room(6000));
  const std::string whole = scratch.file("whole.ply");
  ASSERT_EQ(runProgram({"orient", in, whole, "-q", "--viewpoint=0.2,0.1,0.3", "--open"}).status, 0);
  expectRuns({"orient", in, out, "--viewpoint=0.2,0.1,0.3", "--open"});
  EXPECT_EQ(sameSides(whole, out), 6000U);
}

// Places along a line, and points that those on either side may have seen.
TEST_F(Hints, AStreetFacesWhoWentAlongItAsInMemory) {
  const Room street{{30.0, 8.0, 6.0}, {14.0, 2.0, 0.0}, {18.0, 3.0, 2.0}};
  std::vector<Vector> poses;
  for (int i = 0; i < 12; ++i) poses.push_back({5.0 + 1.7 * i, 5.0 + 0.05 * i, 1.9});
  Scan scan = scanAlong(poses, street);
  const PointView points = scan.view();
  std::vector<double> xyz;
  for (std::size_t i = 0; i < points.size; ++i) xyz.insert(xyz.end(), points[i], points[i] + 3);
  const std::string in = writeDoubles(scratch.file("in.ply"), xyz);
  const std::string whole = scratch.file("whole.ply");
  const Outcome run = runProgram({"orient", in, whole});
  ASSERT_EQ(run.status, 0);
  EXPECT_NE(run.out.find("moving at"), std::string::npos) << run.out;
  ASSERT_EQ(
      runProgram({"orient", in, out, "-q", "--memory", "1G", "--tile-points", "20000"}).status, 0);
  EXPECT_GE(sameSides(whole, out) + points.size / 1000, points.size);
}

// No search finds the places, and no tile could tell from its own points that there were any.
TEST_F(Hints, ARoomFacesWhoWasCarriedAboutInItAsInMemory) {
  const Carried carried = carriedAbout();
  const PointView points = carried.scan.view();
  std::vector<double> xyz;
  for (std::size_t i = 0; i < points.size; ++i) {
    xyz.insert(xyz.end(), points[i], points[i] + 3);
  }
  const std::string in = writeDoubles(scratch.file("in.ply"), xyz);
  const std::string whole = scratch.file("whole.ply");
  ASSERT_EQ(runProgram({"orient", in, whole, "-q"}).status, 0);
  const std::string report = scratch.file("report.json");
  const auto tiles = [&](const char* threads, const std::string& to) {
    return runProgram({"orient", in, to, "-q", "--memory", "1G", "--tile-points", "20000",
                       "--threads", threads, "--report", report})
        .status;
  };
  ASSERT_EQ(tiles("1", out), 0);
  EXPECT_NE(readFile(report).find("\"seen_within\": true"), std::string::npos) << readFile(report);
  EXPECT_GE(sameSides(whole, out) + points.size / 10000, points.size);
  const std::string other = scratch.file("other.ply");
  ASSERT_EQ(tiles("3", other), 0);
  EXPECT_EQ(readFile(other), readFile(out));
  // Who is said to have been far above a room did not see its floor: as if nothing had been said.
  ASSERT_EQ(
      runProgram({"orient", in, other, "-q", "--memory", "1G", "--tile-points", "20000", "--up"})
          .status,
      0);
  EXPECT_GE(sameSides(out, other) + points.size / 10000, points.size);
  std::size_t facing = 0;
  const program::CloudTable cloud = program::readCloud(out);
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto n = cloud.triple(cloud.normals(), i);
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a) sum += n[a] * (carried.from[i][a] - xyz[3 * i + a]);
    facing += sum > 0.0 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(facing), 0.99 * static_cast<double>(points.size));
}

// A landscape goes on behind its hills as seen from below, which no single place could have seen:
// only the whole knows that.
TEST_F(Hints, APlaceBehindWhichTheLandGoesOnIsNotFollowedAsInMemory) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  std::vector<double> xyz;
  for (int i = 0; i < 6000; ++i) {
    const double x = uniform(random);
    const double y = uniform(random);
    const double z =
        0.5 * std::sin(1.7 * x) * std::cos(1.3 * y) + 0.3 * std::cos(0.9 * x + 2.0 * y);
    xyz.insert(xyz.end(), {x, y, z});
  }
  const std::string in = writeDoubles(scratch.file("in.ply"), xyz);
  const std::string whole = scratch.file("whole.ply");
  ASSERT_EQ(runProgram({"orient", in, whole, "-q", "--viewpoint=1,-2,-2"}).status, 0);
  EXPECT_EQ(facingDown(whole), 0U);
  expectRuns({"orient", in, out, "--viewpoint=1,-2,-2"});
  EXPECT_EQ(sameSides(whole, out), 6000U);
  // As the place of each point it is a fact, in both.
  std::vector<double> rows;
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    rows.insert(rows.end(), {xyz[i], xyz[i + 1], xyz[i + 2], 1.0, -2.0, -2.0});
  }
  const std::string told =
      writeFields(scratch.file("told.ply"), {"x", "y", "z", "vp_x", "vp_y", "vp_z"}, rows);
  ASSERT_EQ(runProgram({"orient", told, whole, "-q"}).status, 0);
  expectRuns({"orient", told, out});
  EXPECT_EQ(sameSides(whole, out), 6000U);
}

// A column of places that are all unknown says no more than none.
TEST_F(Hints, UnknownPlacesAreNone) {
  std::vector<double> rows;
  const std::vector<double> xyz = room(6000);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    rows.insert(rows.end(), {xyz[i], xyz[i + 1], xyz[i + 2], nan, nan, nan});
  }
  const std::string in =
      writeFields(scratch.file("in.ply"), {"x", "y", "z", "vp_x", "vp_y", "vp_z"}, rows);
  const std::string folder = scratch.file("work");
  ASSERT_EQ(runProgram({"tiles", "plan", folder, in, out, "--memory", "1G", "--tile-points", "700"})
                .status,
            0);
  ASSERT_EQ(runProgram({"tiles", "tile", folder}).status, 0);
  // With places, each tile would be.
  EXPECT_EQ(runProgram({"tiles", "join", folder}).out, "");
  const std::string report = scratch.file("report.json");
  ASSERT_EQ(
      runProgram({"orient", in, out, "--memory", "1G", "--tile-points", "700", "--report", report})
          .status,
      0);
  std::ifstream file(report);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("\"viewpoint_left_aside\": false"), std::string::npos) << text;
}

// Points that do not know who saw them are told by a search, as in memory.
TEST_F(Hints, PlacesOfSomePointsAreCompleted) {
  Scan scan = scanFrom({2.0, 1.5, 1.4}, 3.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> rows;
  for (std::size_t i = 0; i < scan.rows().size(); i += 3) {
    const float* p = &scan.rows()[i];
    const double known = p[0] < 1.5F ? 1.0 : nan;
    rows.insert(rows.end(), {static_cast<double>(p[0]), static_cast<double>(p[1]),
                             static_cast<double>(p[2]), 2.0 * known, 1.5 * known, 1.4 * known});
  }
  const std::string in =
      writeFields(scratch.file("in.ply"), {"x", "y", "z", "vp_x", "vp_y", "vp_z"}, rows);
  const std::string whole = scratch.file("whole.ply");
  ASSERT_EQ(runProgram({"orient", in, whole, "-q"}).status, 0);
  expectRuns({"orient", in, out});
  const std::size_t points = rows.size() / 6;
  EXPECT_GE(sameSides(whole, out), points - points / 1000);
}

TEST(PlacesSaid, WhatSomePointsSay) {
  using program::PlacesSaid;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const PlacesSaid::Place here{1.0, 2.0, 3.0};
  const PlacesSaid::Place point{0.0, 0.0, 0.0};
  PlacesSaid said;
  EXPECT_TRUE(said.none());
  EXPECT_FALSE(said.partly());
  for (int i = 0; i < 99; ++i) said.add(here, point);
  EXPECT_EQ(said.one(), here);
  said.add({nan, nan, nan}, point);
  EXPECT_FALSE(said.partly()) << "a hundredth follows the surface";
  EXPECT_FALSE(said.one());
  said.add(point, point);  // its own place
  EXPECT_TRUE(said.partly());
  PlacesSaid own;
  own.add(point, point);
  EXPECT_TRUE(own.none());
  EXPECT_FALSE(own.partly());
}

// Ground and fronts along a street, each point seen from the nearest of 20 poses.
TEST_F(Hints, AStreetOfTwentyPosesFacesThemAsInMemory) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> values;
  for (int i = 0; i < 9000; ++i) {
    const double x = 60.0 * uniform(random);
    const double across = uniform(random);
    double y = 8.0 * across - 4.0;
    double z = 0.0;
    if (i % 3 != 0) {
      y = i % 3 == 1 ? 4.0 : -4.0;
      z = 6.0 * across;
    }
    const double pose = std::min(19.0, std::floor(x / 3.0));
    values.insert(values.end(), {x, y, z, 3.0 * pose + 1.5, 0.3, 1.8});
  }
  const std::string in =
      writeFields(scratch.file("in.ply"), {"x", "y", "z", "vp_x", "vp_y", "vp_z"}, values);
  const std::string whole = scratch.file("whole.ply");
  ASSERT_EQ(runProgram({"orient", in, whole, "-q"}).status, 0);
  expectRuns({"orient", in, out});
  EXPECT_EQ(sameSides(whole, out), 9000U);
  const program::CloudTable cloud = program::readCloud(out);
  std::size_t away = 0;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const auto n = cloud.triple(cloud.normals(), i);
    const auto from = cloud.triple(cloud.viewpoints(), i);
    const auto p = cloud.position(i);
    double dot = 0.0;
    for (std::size_t a = 0; a < 3; ++a) dot += n[a] * (from[a] - p[a]);
    away += dot < 0.0 ? 1 : 0;
  }
  EXPECT_LE(away, 9U);
}

}  // namespace
}  // namespace segorient::test
