// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Input that brings its sensors along, through the whole program.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "io/readers.h"
#include "run_program.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::Field;

double valueOf(const CloudTable& table, const std::string& name, std::size_t row) {
  const Field* field = table.find(name);
  EXPECT_NE(field, nullptr) << name;
  return field == nullptr ? NAN : table.value(*field, row);
}

constexpr int kSquare = 600;

// A unit square at height z, a line a point: x y z and, if wanted, a time from 0 to 60.
std::string square(double z, unsigned seed, bool time = false) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::ostringstream out;
  for (int i = 0; i < kSquare; ++i) {
    out << unit(random) << ' ' << unit(random) << ' ' << z;
    if (time) out << ' ' << 0.1 * i;
    out << '\n';
  }
  return out.str();
}

std::string pcdOf(const std::string& points, const std::string& viewpoint,
                  const std::string& more = "") {
  const std::string extra = more.empty() ? "" : " 4";
  return "FIELDS x y z" + more + "\nSIZE 4 4 4" + extra + "\nTYPE F F F" +
         (more.empty() ? "" : " F") + "\nWIDTH " + std::to_string(kSquare) +
         "\nHEIGHT 1\nVIEWPOINT " + viewpoint + " 1 0 0 0\nDATA ascii\n" + points;
}

double shareUp(const CloudTable& table, std::size_t first, std::size_t last) {
  double up = 0.0;
  for (std::size_t i = first; i < last; ++i) up += valueOf(table, "normal_z", i) > 0.0 ? 1.0 : 0.0;
  return up / static_cast<double>(last - first);
}

TEST(Scans, SeveralInputsEachWithItsSensor) {
  const ScratchDirectory directory;
  const std::string a = directory.write("a.pcd", pcdOf(square(0.0, 1), "0.5 0.5 -3"));
  const std::string b = directory.write("b.pcd", pcdOf(square(5.0, 2), "0.5 0.5 9"));
  const std::string c = directory.write("c.xyz", square(20.0, 3));
  for (const char* name : {"out.pcd", "out.ply", "out.las"}) {
    SCOPED_TRACE(name);
    const std::string out = directory.file(name);
    const Outcome run = runProgram({"orient", a, b, c, out});
    ASSERT_EQ(run.status, 0) << run.err;
    const CloudTable table = program::readCloud(out);
    ASSERT_EQ(table.size, 3U * kSquare);
    EXPECT_NEAR(table.position(0)[0], program::readCloud(a).position(0)[0], 1e-6);
    EXPECT_NEAR(table.position(2 * kSquare)[1], program::readCloud(c).position(0)[1], 1e-6);
    EXPECT_EQ(valueOf(table, "scan", kSquare - 1), 0.0);
    EXPECT_EQ(valueOf(table, "scan", kSquare), 1.0);
    EXPECT_EQ(valueOf(table, "scan", 2 * kSquare), 2.0);
    EXPECT_EQ(valueOf(table, "vp_z", 0), -3.0);
    EXPECT_EQ(valueOf(table, "vp_z", kSquare), 9.0);
    EXPECT_TRUE(std::isnan(valueOf(table, "vp_z", 2 * kSquare)));
    EXPECT_EQ(shareUp(table, 0, kSquare), 0.0);
    EXPECT_EQ(shareUp(table, kSquare, 2 * kSquare), 1.0);
  }
  // What was written knows its sensors.
  const std::string again = directory.file("again.ply");
  ASSERT_EQ(runProgram({"orient", directory.file("out.ply"), again, "-q"}).status, 0);
  EXPECT_EQ(shareUp(program::readCloud(again), 0, kSquare), 0.0);
}

TEST(Scans, ViewpointOfAPcdIsKeptInPly) {
  const ScratchDirectory directory;
  const std::string a = directory.write("a.pcd", pcdOf(square(0.0, 1), "0.5 0.5 -3"));
  ASSERT_EQ(runProgram({"orient", a, directory.file("out.ply"), "-q"}).status, 0);
  const CloudTable table = program::readCloud(directory.file("out.ply"));
  EXPECT_EQ(valueOf(table, "vp_z", 7), -3.0);
  EXPECT_EQ(table.find("scan"), nullptr);
  EXPECT_EQ(shareUp(table, 0, kSquare), 0.0);
}

TEST(Scans, OneInputThatCannotBeReadLeavesNothing) {
  const ScratchDirectory directory;
  const std::string a = directory.write("a.xyz", square(0.0, 1));
  const Outcome run =
      runProgram({"orient", a, directory.file("missing.ptx"), directory.file("out.ply")});
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(isOneLine(run.err)) << run.err;
  EXPECT_NE(run.err.find("missing.ptx"), std::string::npos);
  EXPECT_EQ(directory.entries(), 1U);
}

TEST(Scans, ATrajectoryIsJoinedByTime) {
  const ScratchDirectory directory;
  const std::string a = directory.write("a.txt", "x y z gps_time\n" + square(0.0, 1, true));
  // From below the square to far beside it; it ends before the last points were measured.
  const std::string path = directory.write("path.txt", "# time x y z\n0 0 0 -10\n50 100 0 -10\n");
  const std::string out = directory.file("out.ply");
  const Outcome run = runProgram({"orient", a, out, "--trajectory", path});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(isOneLine(run.err)) << run.err;
  EXPECT_NE(run.err.find("99 points"), std::string::npos) << run.err;
  const CloudTable table = program::readCloud(out);
  EXPECT_NEAR(valueOf(table, "vp_x", 250), 50.0, 1e-4);
  EXPECT_NEAR(valueOf(table, "vp_z", 250), -10.0, 1e-5);
  EXPECT_TRUE(std::isnan(valueOf(table, "vp_x", 550)));
  EXPECT_EQ(shareUp(table, 0, kSquare), 0.0) << "the rest follows the surface";
}

TEST(Scans, TrajectoriesThatDoNotFit) {
  const ScratchDirectory directory;
  const std::string a = directory.write("a.txt", "x y z gps_time\n" + square(0.0, 1, true));
  const std::string out = directory.file("out.ply");
  const auto outcome = [&](const std::string& input, const std::string& poses) {
    return runProgram(
        {"orient", input, out, "-q", "--trajectory", directory.write("path.txt", poses)});
  };
  const Outcome shifted = outcome(a, "1000000000 0 0 1\n1000000060 1 1 1\n");
  EXPECT_EQ(shifted.status, 1);
  EXPECT_TRUE(isOneLine(shifted.err)) << shifted.err;
  EXPECT_NE(shifted.err.find("1e9"), std::string::npos) << shifted.err;
  const Outcome none = outcome(a, "500 0 0 1\n600 1 1 1\n");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("points 0 to 59.9"), std::string::npos) << none.err;
  const Outcome timeless = outcome(directory.write("b.xyz", square(0.0, 1)), "0 0 0 1\n");
  EXPECT_EQ(timeless.status, 1);
  EXPECT_NE(timeless.err.find("gps_time"), std::string::npos) << timeless.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Scans, UpIsASensorFarAbove) {
  const ScratchDirectory directory;
  const std::string a = directory.write("a.pcd", pcdOf(square(0.0, 1), "0.5 0.5 -3"));
  const std::string b = directory.write("b.xyz", square(5.0, 2));
  const std::string out = directory.file("out.pcd");
  ASSERT_EQ(runProgram({"orient", a, b, out, "--up", "-q"}).status, 0);
  EXPECT_EQ(shareUp(program::readCloud(out), 0, 2 * kSquare), 1.0);
  EXPECT_EQ(runProgram({"orient", a, out, "--up", "--viewpoint=0,0,1"}).status, 2);
}

}  // namespace
}  // namespace segorient::test
