// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// PTX, PTS, trajectories, and several clouds that become one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "io/join_clouds.h"
#include "io/readers.h"
#include "scratch_directory.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::Field;
using program::FileError;
using program::joinClouds;
using program::readCloud;
using program::readTrajectory;

double valueOf(const CloudTable& table, const std::string& name, std::size_t row) {
  const Field* field = table.find(name);
  EXPECT_NE(field, nullptr) << name;
  return field == nullptr ? NAN : table.value(*field, row);
}

template <typename Read>
std::string outcomeOf(const Read& read) {
  try {
    read();
    return "read";
  } catch (const FileError& e) {
    return e.what();
  }
}

std::string outcome(const std::string& path) {
  return outcomeOf([&] { readCloud(path); });
}

// A scan that stands at (10, 20, 3), turned by 90 degrees about z: x goes to y, y to -x.
const char* const kTurned =
    "2\n3\n10 20 3\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 3 1\n"
    "1 0 0 0.5\n0 2 0 0.25\n0 0 0 0.5\n0 0 3 1\n1 1 1 0\n2 2 2 0.125\n";

TEST(Ptx, OneScanStaysAGridInTheCoordinatesOfItsPose) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(directory.write("a.ptx", kTurned));
  ASSERT_EQ(table.size, 6U);
  EXPECT_EQ(table.width, 3U);
  EXPECT_EQ(table.height, 2U);
  const auto first = table.position(0);
  EXPECT_DOUBLE_EQ(first[0], 10.0);
  EXPECT_DOUBLE_EQ(first[1], 21.0);
  EXPECT_DOUBLE_EQ(first[2], 3.0);
  EXPECT_DOUBLE_EQ(table.position(1)[0], 8.0);
  for (const double v : table.position(2)) EXPECT_TRUE(std::isnan(v)) << "nothing was seen";
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(valueOf(table, "vp_x", i), 10.0);
    EXPECT_EQ(valueOf(table, "vp_y", i), 20.0);
    EXPECT_EQ(valueOf(table, "vp_z", i), 3.0);
  }
  EXPECT_EQ(valueOf(table, "intensity", 1), 0.25);
  EXPECT_EQ(table.find("scan"), nullptr);
}

TEST(Ptx, SeveralScansAreCountedAndOnlyWhatWasSeenStays) {
  const ScratchDirectory directory;
  const std::string second =
      "1\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
      "1 2 3 0.5 255 0 7\n0 0 0 0.5 0 0 0\n";
  const CloudTable table = readCloud(directory.write("a.ptx", kTurned + second));
  ASSERT_EQ(table.size, 6U);
  EXPECT_EQ(table.height, 1U);
  EXPECT_EQ(valueOf(table, "scan", 4), 0.0);
  EXPECT_EQ(valueOf(table, "scan", 5), 1.0);
  EXPECT_EQ(valueOf(table, "vp_x", 5), 0.0) << "a scanner may stand at the origin";
  EXPECT_EQ(table.position(5)[2], 3.0);
  ASSERT_EQ(table.notes.size(), 1U);
  EXPECT_EQ(table.notes[0].compare(0, 2, "2 "), 0) << table.notes[0];
}

TEST(Ptx, ColoursAndMapCoordinates) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(
      directory.write("a.ptx",
                      "1\n2\n4000000 5000000 100\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                      "4000000 5000000 100 1\n0.001 2 3 0.5 255 0 7\n1 1 1 0.5 1 2 3\n"));
  EXPECT_EQ(table.find("x")->size, 8U);
  EXPECT_DOUBLE_EQ(table.position(0)[0], 4000000.001);
  std::uint32_t rgb = 0;
  std::memcpy(&rgb, table.at(*table.find("rgb"), 0), 4);
  EXPECT_EQ(rgb, 0xff0007U);
}

TEST(Ptx, PointsThatWereMovedAlreadyHaveTheScannersPlaceInTheHeader) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(directory.write(
      "a.ptx", "1\n1\n5 6 7\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0\n"));
  EXPECT_EQ(valueOf(table, "vp_y", 0), 6.0);
  EXPECT_EQ(table.position(0)[0], 1.0);
}

TEST(Ptx, FilesThatAreNotWhole) {
  const ScratchDirectory directory;
  const std::string whole = kTurned;
  for (std::size_t length = 0; length + 2 < whole.size(); ++length) {
    const std::string result = outcome(directory.write("cut.ptx", whole.substr(0, length)));
    // Only the last number may be cut without a trace.
    if (length + 16 < whole.size()) {
      EXPECT_NE(result, "read") << length;
    }
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char damage : {'9', '\n', 'x'}) {
      std::string content = whole;
      content[at] = damage;
      outcome(directory.write("damaged.ptx", content));  // must come back
    }
  }
  EXPECT_NE(
      outcome(directory.write("big.ptx", "999999\n999999\n" + whole.substr(4))).find("cut short"),
      std::string::npos);
  const std::string singular =
      "1\n1\n5 6 7\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n1 1 0 0\n0 0 0 1\n1 2 3 0\n";
  EXPECT_NE(outcome(directory.write("flat.ptx", singular)).find("flatten"), std::string::npos);
  EXPECT_NE(outcome(directory.write("half.ptx", "1.5\n3\n" + whole.substr(4))).find("grid"),
            std::string::npos);
}

TEST(Pts, ScansIntensityAndColours) {
  const ScratchDirectory directory;
  const CloudTable table = readCloud(
      directory.write("a.pts", "2\n1 2 3 -500 10 20 30\n4 5 6 7 0 0 255\n1\n7 8 9 1 1 1 1\n"));
  ASSERT_EQ(table.size, 3U);
  EXPECT_EQ(valueOf(table, "intensity", 0), -500.0);
  EXPECT_EQ(valueOf(table, "scan", 1), 0.0);
  EXPECT_EQ(valueOf(table, "scan", 2), 1.0);
  std::uint32_t rgb = 0;
  std::memcpy(&rgb, table.at(*table.find("rgb"), 0), 4);
  EXPECT_EQ(rgb, 10U << 16 | 20U << 8 | 30U);
  EXPECT_EQ(readCloud(directory.write("b.pts", "1 2 3\n")).find("scan"), nullptr);
  EXPECT_TRUE(readCloud(directory.write("c.pts", "1\n1 2 3 0 0.6 -0.8\n")).hasNormals());
}

TEST(Pts, CountsThatLie) {
  const ScratchDirectory directory;
  EXPECT_NE(outcome(directory.write("a.pts", "3\n1 2 3\n4 5 6\n")).find("cut short"),
            std::string::npos);
  EXPECT_NE(outcome(directory.write("a.pts", "4000000000\n1 2 3\n")).find("cut short"),
            std::string::npos);
  EXPECT_NE(outcome(directory.write("a.pts", "2\n1 2 3\n1\n1 2 3\n")).find("line 3"),
            std::string::npos);
  EXPECT_EQ(readCloud(directory.write("a.pts", "1\n1 2 3\n4 5 6\n")).notes.size(), 1U);
  EXPECT_NE(outcome(directory.write("a.pts", "1\n1 2 3 4 5\n")).find("no point"),
            std::string::npos);
}

TEST(TrajectoryFile, NumbersCommentsAndNames) {
  const ScratchDirectory directory;
  const Trajectory plain = readTrajectory(
      directory.write("a.txt", "# time x y z\n\n% more\n2 1 0 0 0.1 0.2\n1 0 0 5\n"));
  ASSERT_EQ(plain.size(), 2U);
  EXPECT_EQ(plain.poses()[0].position[2], 5.0) << "by time";
  const Trajectory named =
      readTrajectory(directory.write("b.csv", "X,Y,Z,GPS_Time\n1,2,3,100\n4,5,6,101\n"));
  EXPECT_EQ(named.begin(), 100.0);
  EXPECT_EQ(named.poses()[1].position[0], 4.0);
  const Trajectory more = readTrajectory(
      directory.write("c.txt", "0 5 0 0 # start\n4000 5 0 7 station A\n5000 6 0 0 // end\n"));
  ASSERT_EQ(more.size(), 3U);
  EXPECT_EQ(more.poses()[1].position[2], 7.0);
  const Trajectory among =
      readTrajectory(directory.write("d.csv", "time,station,x,y,z,note\n8,A,1,2,3,halt\n"));
  EXPECT_EQ(among.poses()[0].position[2], 3.0);
}

TEST(TrajectoryFile, BadOnes) {
  const ScratchDirectory directory;
  const auto result = [&](const std::string& text) {
    const std::string path = directory.write("a.txt", text);
    return outcomeOf([&] { readTrajectory(path); });
  };
  EXPECT_NE(result("1 2 3\n").find("line 1"), std::string::npos);
  EXPECT_NE(result("1 2 3 4\n1 2 3 x\n").find("line 2"), std::string::npos);
  EXPECT_NE(result("1 2 3 4\n1 2 3 # 4\n").find("line 2"), std::string::npos);
  EXPECT_NE(result("# nothing\n").find("no poses"), std::string::npos);
  EXPECT_NE(result("a b c\n1 2 3 4\n").find("names"), std::string::npos);
  EXPECT_NE(result("nan 1 2 3\n").find("no poses"), std::string::npos);
}

CloudTable cloudOf(const ScratchDirectory& directory, const std::string& name,
                   const std::string& text) {
  return readCloud(directory.write(name, text));
}

TEST(JoinClouds, PointsScansViewpointsAndFillers) {
  const ScratchDirectory directory;
  std::vector<CloudTable> clouds;
  clouds.push_back(
      cloudOf(directory, "a.pcd",
              "FIELDS x y z intensity ring\nSIZE 4 4 4 4 1\nTYPE F F F F U\nWIDTH 1\nHEIGHT 2\n"
              "VIEWPOINT 7 8 9 1 0 0 0\nDATA ascii\n1 2 3 0.5 4\n4 5 6 1.5 200\n"));
  clouds.push_back(cloudOf(directory, "b.ply",
                           "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty "
                           "double y\nproperty double z\nproperty uchar red\nproperty uchar "
                           "green\nproperty uchar blue\nend_header\n0.1 0.2 0.3 1 2 3\n"));
  clouds.push_back(cloudOf(directory, "c.ptx", kTurned));
  const CloudTable joint = joinClouds(std::move(clouds), {"a", "b", "c"}, true);
  ASSERT_EQ(joint.size, 9U);
  EXPECT_EQ(joint.find("x")->size, 8U) << "what holds both";
  EXPECT_EQ(joint.position(1)[2], 6.0);
  EXPECT_EQ(joint.position(2)[0], 0.1);
  EXPECT_EQ(valueOf(joint, "scan", 1), 0.0);
  EXPECT_EQ(valueOf(joint, "scan", 2), 1.0);
  EXPECT_EQ(valueOf(joint, "scan", 3), 2.0);
  EXPECT_EQ(valueOf(joint, "vp_y", 0), 8.0);
  EXPECT_TRUE(std::isnan(valueOf(joint, "vp_y", 2))) << "nothing is known of the second's sensor";
  EXPECT_EQ(valueOf(joint, "vp_y", 3), 20.0);
  EXPECT_TRUE(std::isnan(valueOf(joint, "intensity", 2)));
  EXPECT_EQ(valueOf(joint, "ring", 1), 200.0);
  EXPECT_EQ(valueOf(joint, "ring", 2), 0.0);
  std::uint32_t rgb = 1;
  std::memcpy(&rgb, joint.at(*joint.find("rgb"), 0), 4);
  EXPECT_EQ(rgb, 0U);
  ASSERT_EQ(joint.grids.size(), 2U);
  EXPECT_EQ(joint.grids[1].first, 3U);
  EXPECT_EQ(joint.grids[1].width, 3U);
  EXPECT_EQ(joint.viewpoint[0], 0.0);
}

TEST(JoinClouds, ScansAreNumberedThrough) {
  const ScratchDirectory directory;
  std::vector<CloudTable> clouds;
  clouds.push_back(cloudOf(directory, "a.pts", "1\n1 2 3\n1\n4 5 6\n"));
  clouds.push_back(cloudOf(directory, "b.xyz", "7 8 9\n"));
  const CloudTable joint = joinClouds(std::move(clouds), {"a", "b"}, true);
  EXPECT_EQ(valueOf(joint, "scan", 1), 1.0);
  EXPECT_EQ(valueOf(joint, "scan", 2), 2.0);
  EXPECT_EQ(joint.find("vp_x"), nullptr);
}

TEST(JoinClouds, FieldsOfDifferentLengthAreLeftOutWithANote) {
  const ScratchDirectory directory;
  const std::string rest = "\nWIDTH 1\nHEIGHT 1\nDATA ascii\n";
  std::vector<CloudTable> clouds;
  clouds.push_back(
      cloudOf(directory, "a.pcd",
              "FIELDS x y z f\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 2" + rest + "1 2 3 4 5\n"));
  clouds.push_back(
      cloudOf(directory, "b.pcd",
              "FIELDS x y z f\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1" + rest + "1 2 3 4\n"));
  const CloudTable joint = joinClouds(std::move(clouds), {"a", "b"}, true);
  EXPECT_EQ(joint.find("f"), nullptr);
  ASSERT_EQ(joint.notes.size(), 1U);
}

}  // namespace
}  // namespace segorient::test
