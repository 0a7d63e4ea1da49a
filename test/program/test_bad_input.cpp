// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Clouds that have nothing to go by, through every command: status 1 and one line, or a defined
// result.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <sstream>

#include "bad_clouds.h"
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
  for (const std::string& input : inputs) {
    std::vector<std::vector<std::string>> lines{
        {"compare", input}, {"evaluate", input, fandisk()}, {"evaluate", fandisk(), input}};
    for (const Command& command : kCommands) {
      lines.push_back({command.name, input, directory.file(command.output)});
    }
    for (const std::vector<std::string>& words : lines) {
      SCOPED_TRACE(words[0] + " " + input);
      const Outcome run = runProgram(words);
      EXPECT_EQ(run.status, 1);
      EXPECT_TRUE(isOneLine(run.err)) << run.err;
      EXPECT_NE(run.err.find(input + ": "), std::string::npos) << run.err;
      EXPECT_TRUE(run.out.empty()) << run.out;
      EXPECT_EQ(directory.entries(), before);
    }
  }
}

std::string asText(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  std::ostringstream text;
  text.precision(9);
  for (const auto& p : cloud) text << p.x << ' ' << p.y << ' ' << p.z << '\n';
  return text.str();
}

// Every command on every cloud that code like this fails on: a result of the same size with unit
// normals or none, or one line of what is wrong.
class EveryCommand : public testing::TestWithParam<std::string> {
 protected:
  void check(const std::string& name, const Outcome& run, bool usable) {
    SCOPED_TRACE(GetParam() + " " + name);
    EXPECT_EQ(run.status, usable ? 0 : 1) << run.err;
    EXPECT_TRUE(usable || isOneLine(run.err)) << run.err;
  }

  void checkNormals(const BadCloud& bad, const std::string& path) {
    const program::CloudTable table = program::readCloud(path);
    ASSERT_EQ(table.size, bad.cloud->size());
    for (std::size_t i = 0; i < table.size; ++i) {
      const auto n = table.triple(table.normals(), i);
      const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      const bool valid = pointOf(*bad.cloud, nullptr, i) != nullptr;
      if (!valid || bad.planes == Planes::NONE) {
        EXPECT_TRUE(std::isnan(length)) << i;
      } else if (!std::isnan(length)) {
        EXPECT_NEAR(length, 1.0, 1e-4) << i;
      }
    }
  }

  const ScratchDirectory directory_;
};

TEST_P(EveryCommand, CopesWithEveryCloud) {
  for (const BadCloud& bad : badClouds()) {
    const std::string in = directory_.write("in.xyz", asText(*bad.cloud));
    const std::string out = directory_.file(GetParam() == "render" ? "out.png" : "out.ply");
    // PCL's kd-tree, which these run beside ours, aborts on coordinates near the largest float.
    const bool with_pcl = GetParam() == "knn" || GetParam() == "compare";
    const bool usable = bad.name.find("all NaN") == std::string::npos && !bad.cloud->empty() &&
                        !(with_pcl && bad.name == "largest floats");
    std::vector<std::string> words{GetParam(), in, out};
    if (GetParam() == "compare" || GetParam() == "evaluate") words.pop_back();
    if (GetParam() == "knn") words.back() = directory_.file("out.csv");
    if (GetParam() == "evaluate") {
      // The cloud against its own result, which has normals where there are any.
      words = {"evaluate", out, out};
      const bool oriented = runProgram({"orient", in, out, "-q"}).status == 0;
      EXPECT_EQ(oriented, usable) << bad.name;
      if (!oriented) continue;
      const Outcome run = runProgram(words);
      EXPECT_LE(run.status, 1) << bad.name << ": " << run.err;
      continue;
    }
    check(bad.name, runProgram(words), usable);
    const bool has_normals = GetParam() == "orient" || GetParam() == "normals" ||
                             GetParam() == "segment" || GetParam() == "triangulate";
    if (usable && has_normals) checkNormals(bad, out);
    std::filesystem::remove(out);
  }
}

INSTANTIATE_TEST_SUITE_P(BadInput, EveryCommand,
                         testing::Values("orient", "normals", "segment", "triangulate", "knn",
                                         "compare", "evaluate", "render"),
                         [](const auto& command) { return command.param; });

// As on a full disk, but for whoever runs the test.
TEST(BadInput, AFullDiskLeavesThePreviousOutput) {
  const ScratchDirectory directory;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const Command& command : kCommands) {
    SCOPED_TRACE(command.name);
    const std::string out = directory.write(command.output, "precious");
    const rlimit small{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const Outcome run = runProgram({command.name, fandisk(), out});
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_EQ(readFile(out), "precious");
    std::filesystem::remove(out);
    EXPECT_EQ(directory.entries(), 0U);
  }
}

// The cloud still fits on the disk, what is said of it does not.
TEST(BadInput, AFullDiskLeavesThePreviousReport) {
  const ScratchDirectory directory;
  const std::string in = directory.write("in.xyz", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n");
  const std::string out = directory.file("out.pcd");
  const std::string report = directory.file("report.json");
  ASSERT_EQ(runProgram({"orient", in, out, "--report", report}).status, 0);
  const std::size_t size = readFile(report).size();
  ASSERT_GT(size, readFile(out).size() + 100);
  directory.write("report.json", "precious");
  const std::size_t entries = directory.entries();
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{size - 100, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const Outcome run = runProgram({"orient", in, out, "--report", report});
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(isOneLine(run.err)) << run.err;
  EXPECT_EQ(readFile(report), "precious");
  EXPECT_EQ(directory.entries(), entries);
}

// What was compared is said all the same.
TEST(BadInput, AFullDiskLeavesThePreviousPictures) {
  const ScratchDirectory directory;
  const std::string picture = directory.write("compare.png", "precious");
  const std::string poisson = directory.write("poisson.png", "precious");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--picture", picture},
        {"--poisson", directory.file("poisson"), "--depth", "4"}}) {
    std::vector<std::string> words{"compare", fandisk()};
    words.insert(words.end(), options.begin(), options.end());
    const rlimit small{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const Outcome run = runProgram(words);
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(run.status, 1) << options[0];
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_EQ(directory.entries(), 2U) << options[0];
  }
  EXPECT_EQ(readFile(picture), "precious");
  EXPECT_EQ(readFile(poisson), "precious");
}

// Two rows of points, with and without coordinates.
TEST(BadInput, OrganisedCloudsStaySo) {
  const ScratchDirectory directory;
  std::string text = kPcd + "WIDTH 40\nHEIGHT 10\nPOINTS 400\nDATA ascii\n";
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 40; ++x) {
      const bool hole = x % 7 == 3;
      text += (hole ? "nan" : std::to_string(x)) + ' ' + std::to_string(y) + " 0\n";
    }
  }
  const std::string in = directory.write("in.pcd", text);
  for (const std::string command : {"orient", "normals", "segment"}) {
    const std::string out = directory.file("out.pcd");
    ASSERT_EQ(runProgram({command, in, out}).status, 0) << command;
    const program::CloudTable table = program::readCloud(out);
    EXPECT_EQ(table.size, 400U) << command;
    EXPECT_EQ(table.width, 40U) << command;
    EXPECT_EQ(table.height, 10U) << command;
    for (std::size_t i = 0; i < table.size; ++i) {
      EXPECT_EQ(std::isnan(table.triple(table.normals(), i)[0]), i % 40 % 7 == 3) << command;
    }
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
