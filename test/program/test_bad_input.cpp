// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Clouds that have nothing to go by, through every command: status 1 and one line, or a defined
// result.
#include <gtest/gtest.h>

#include <cmath>

#include "io/readers.h"
#include "run_program.h"

namespace segorient::test {
namespace {

const std::string kPcd = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";

struct Command {
  const char* name;
  const char* output;
};
const std::vector<Command> kCommands{{"orient", "out.pcd"},      {"normals", "out.ply"},
                                     {"segment", "out.pcd"},     {"render", "out.png"},
                                     {"triangulate", "out.ply"}, {"knn", "out.csv"}};

TEST(BadInput, FilesThatCannotBeUsed) {
  const ScratchDirectory directory;
  std::filesystem::create_directory(directory.file("folder.pcd"));
  const std::string whole = readFile(fandisk());
  const std::vector<std::string> inputs{
      directory.file("missing.pcd"),
      directory.file("folder.pcd"),
      directory.write("empty.pcd", ""),
      directory.write("zero.pcd", kPcd + "WIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA ascii\n"),
      directory.write("nan.pcd", kPcd + "POINTS 2\nDATA ascii\nnan nan nan\nnan 1 2\n"),
      directory.write("no_xyz.pcd", "FIELDS a\nSIZE 4\nTYPE F\nPOINTS 1\nDATA ascii\n1\n"),
      directory.write("many.pcd", kPcd + "POINTS 4000000000\nDATA binary\n0123"),
      directory.write("short.pcd", whole.substr(0, whole.size() / 2)),
      directory.write("short_header.pcd", whole.substr(0, 100)),
      directory.write("words.txt", "once upon a time\n")};
  const std::size_t before = directory.entries();
  for (const Command& command : kCommands) {
    for (const std::string& input : inputs) {
      SCOPED_TRACE(std::string(command.name) + " " + input);
      const Outcome run = runProgram({command.name, input, directory.file(command.output)});
      EXPECT_EQ(run.status, 1);
      EXPECT_TRUE(isOneLine(run.err)) << run.err;
      EXPECT_NE(run.err.find(input + ": "), std::string::npos) << run.err;
      EXPECT_TRUE(run.out.empty()) << run.out;
      EXPECT_EQ(directory.entries(), before);
    }
  }
}

TEST(BadInput, TooFewOrDegeneratePointsGetNoNormal) {
  const ScratchDirectory directory;
  const std::vector<std::string> clouds{"1 2 3\n",
                                        "1 2 3\n4 5 6\n",
                                        "1 2 3\n1 2 3\n1 2 3\n1 2 3\n",
                                        "0 0 0\n1 1 1\n2 2 2\n3 3 3\n4 4 4\n",
                                        "0 0 0\n1e30 0 0\n",
                                        "0 0 0\n1e-40 0 0\n"};
  for (const std::string& text : clouds) {
    const std::string in = directory.write("in.xyz", text);
    for (const std::string command : {"orient", "normals", "segment", "triangulate"}) {
      SCOPED_TRACE(command + " " + text);
      const std::string out = directory.file("out.ply");
      const Outcome run = runProgram({command, in, out});
      ASSERT_EQ(run.status, 0) << run.err;
      const program::CloudTable table = program::readCloud(out);
      EXPECT_EQ(table.size, program::readCloud(in).size);
      for (std::size_t i = 0; i < table.size; ++i) {
        EXPECT_TRUE(std::isnan(table.triple(table.normals(), i)[0]));
      }
      if (command == "orient" || command == "normals") {
        EXPECT_NE(run.out.find("without normal  " + std::to_string(table.size)), std::string::npos)
            << run.out;
      }
    }
    const Outcome picture = runProgram({"render", in, directory.file("out.png")});
    EXPECT_EQ(picture.status, 0) << picture.err;
  }
}

TEST(BadInput, PointsWithoutCoordinatesAndRepeatedOnesKeepTheirPlace) {
  const ScratchDirectory directory;
  std::string text;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      const std::string point = std::to_string(x) + " " + std::to_string(y) + " 0\n";
      text += point + (x % 2 == 0 ? point : "nan nan nan\n");
    }
  }
  const std::string out = directory.file("out.pcd");
  const Outcome run = runProgram({"orient", directory.write("in.xyz", text), out});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("200 not finite, 200 duplicates"), std::string::npos) << run.out;
  const program::CloudTable table = program::readCloud(out);
  ASSERT_EQ(table.size, 800U);
  for (std::size_t i = 0; i < table.size; ++i) {
    const bool finite = std::isfinite(table.position(i)[0]);
    EXPECT_EQ(std::isfinite(table.triple(table.normals(), i)[2]), finite) << i;
    if (!finite) continue;
    EXPECT_NEAR(std::abs(table.triple(table.normals(), i)[2]), 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace segorient::test
