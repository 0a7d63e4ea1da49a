// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The whole program on the shipped Fandisk, and evaluate on results whose score is known.
#include <gtest/gtest.h>
#include <boost/property_tree/json_parser.hpp>

#include <cmath>
#include <set>
#include <sstream>

#include "io/readers.h"
#include "run_program.h"

namespace segorient::test {
namespace {

using boost::property_tree::ptree;
using program::CloudTable;
using program::readCloud;

ptree readJson(const std::string& path) {
  ptree tree;
  boost::property_tree::read_json(path, tree);
  return tree;
}

// Four points a part; their true normals are (0, 0, 1).
std::string cloud(const std::vector<std::array<double, 3>>& normals, bool parts) {
  std::ostringstream text;
  text << "x y z nx ny nz" << (parts ? " part" : "") << "\n";
  for (std::size_t i = 0; i < normals.size(); ++i) {
    text << i << " 0 0 " << normals[i][0] << ' ' << normals[i][1] << ' ' << normals[i][2];
    if (parts) text << ' ' << i / 4;
    text << "\n";
  }
  return text.str();
}

TEST(Evaluate, CountsWhatIsRightFlippedMissingAndTilted) {
  const ScratchDirectory directory;
  const std::array<double, 3> up{0, 0, 1};
  const std::array<double, 3> down{0, 0, -2};
  const std::array<double, 3> tilted{0, std::sin(M_PI / 6), std::cos(M_PI / 6)};
  const std::array<double, 3> none{NAN, NAN, NAN};
  const std::string truth = directory.write("truth.xyz", cloud({8, up}, true));
  const std::string result =
      directory.write("result.xyz", cloud({up, tilted, none, up, down, down, down, up}, false));
  const std::string report = directory.file("report.json");
  const Outcome run = runProgram({"evaluate", truth, result, "--report", report});
  ASSERT_EQ(run.status, 0) << run.err;
  const ptree json = readJson(report);
  EXPECT_EQ(json.get<int>("points"), 8);
  EXPECT_EQ(json.get<int>("without_normal"), 1);
  EXPECT_EQ(json.get<double>("oriented_percent"), 50.0);
  EXPECT_EQ(json.get<double>("oriented_percent_global_flip"), 50.0);
  EXPECT_EQ(json.get<double>("oriented_percent_part_flips"), 75.0);
  EXPECT_EQ(json.get<int>("parts"), 2);
  EXPECT_NEAR(json.get<double>("angle_degrees.rms"), 30.0 / std::sqrt(7.0), 1e-4);
  EXPECT_NEAR(json.get<double>("angle_degrees.median"), 0.0, 1e-6);
  EXPECT_NE(run.out.find("50.0000 %  (4 wrong)"), std::string::npos) << run.out;
}

TEST(Evaluate, AGlobalFlipIsFoundAndSaid) {
  const ScratchDirectory directory;
  const std::string truth = directory.write("truth.xyz", cloud({4, {0, 0, 1}}, false));
  const std::string result =
      directory.write("result.xyz", cloud({{0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {0, 0, 1}}, false));
  const Outcome run = runProgram({"evaluate", truth, result});
  EXPECT_NE(run.out.find("25.0000 %"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("75.0000 %  (1 wrong; flipped)"), std::string::npos) << run.out;
}

TEST(Evaluate, WithoutNormalsThereIsNoAngle) {
  const ScratchDirectory directory;
  const std::string some = directory.write("some.xyz", cloud({4, {0, 0, 1}}, false));
  const std::string none = directory.write("none.xyz", cloud({4, {0, 0, 0}}, false));
  const std::string report = directory.file("report.json");
  const Outcome run = runProgram({"evaluate", some, none, "--report", report});
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.out.find("true normal    -\n"), std::string::npos) << run.out;
  for (const char* angle : {"rms", "median", "p90"}) {
    EXPECT_EQ(readJson(report).get<std::string>(std::string("angle_degrees.") + angle), "null");
  }
  const Outcome untrue = runProgram({"evaluate", none, some});
  EXPECT_EQ(untrue.status, 1);
  EXPECT_TRUE(isOneLine(untrue.err)) << untrue.err;
}

TEST(Evaluate, CloudsThatDoNotMatchAreRefused) {
  const ScratchDirectory directory;
  const std::string truth =
      directory.write("truth.xyz", "x y z nx ny nz\n0 0 0 0 0 1\n1 0 0 0 0 1\n");
  const std::vector<std::string> others{"x y z nx ny nz\n0 0 0 0 0 1\n",
                                        "x y z nx ny nz\n0 0 0 0 0 1\n1 0.01 0 0 0 1\n",
                                        "x y z\n0 0 0\n1 0 0\n"};
  for (const std::string& other : others) {
    const Outcome run = runProgram({"evaluate", truth, directory.write("result.xyz", other)});
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
  }
}

TEST(Fandisk, IsOrientedOutward) {
  const ScratchDirectory directory;
  const std::string out = directory.file("oriented.pcd");
  const std::string report = directory.file("report.json");
  const Outcome run = runProgram({"orient", fandisk(), out, "--report", report});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(run.err.empty()) << run.err;  // no progress where there is no terminal
  const ptree json = readJson(report);
  EXPECT_EQ(json.get<int>("points"), 16475);
  EXPECT_EQ(json.get<int>("without_normal"), 0);
  EXPECT_EQ(json.get_child("components").size(), 1U);

  const std::string score = directory.file("score.json");
  ASSERT_EQ(runProgram({"evaluate", fandisk(), out, "--report", score}).status, 0);
  EXPECT_GE(readJson(score).get<double>("oriented_percent"), 99.5);

  const CloudTable table = readCloud(out);
  std::vector<std::string> names;
  for (const program::Field& f : table.fields) names.push_back(f.name);
  EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z", "normal_x", "normal_y", "normal_z",
                                             "curvature", "rgb", "label"}));
}

TEST(Fandisk, IsSegmentedIntoItsFaces) {
  const ScratchDirectory directory;
  const std::string out = directory.file("segments.ply");
  ASSERT_EQ(runProgram({"segment", fandisk(), out}).status, 0);
  const CloudTable table = readCloud(out);
  const CloudTable truth = readCloud(fandisk());
  ASSERT_NE(table.find("segment_kind"), nullptr);
  std::set<double> regular;
  for (std::size_t i = 0; i < table.size; ++i) {
    if (table.value(*table.find("segment_kind"), i) == 0.0) {
      regular.insert(table.value(*table.find("label"), i));
    }
  }
  EXPECT_GE(regular.size(), 12U);
  EXPECT_LE(regular.size(), 60U);
}

TEST(Fandisk, PicturesAreWritten) {
  const ScratchDirectory directory;
  const std::string png = directory.file("picture.png");
  ASSERT_EQ(runProgram({"render", fandisk(), png}).status, 0);
  EXPECT_EQ(readFile(png).compare(1, 3, "PNG"), 0);
}

// Map coordinates: what floats cannot hold must come out as it went in.
TEST(Program, KeepsDoublesOffsetsAndOtherFields) {
  const ScratchDirectory directory;
  const CloudTable source = readCloud(fandisk());
  std::ostringstream text;
  text.precision(12);
  text << "VERSION 0.7\nFIELDS x y z intensity time\nSIZE 8 8 8 4 8\nTYPE F F F F F\n"
       << "COUNT 1 1 1 1 1\nWIDTH " << source.size << "\nHEIGHT 1\nPOINTS " << source.size
       << "\nDATA ascii\n";
  for (std::size_t i = 0; i < source.size; ++i) {
    const auto p = source.position(i);
    text << 500000.0 + p[0] << ' ' << 5400000.0 + p[1] << ' ' << p[2] << ' ' << i << ' '
         << 1.6e9 + static_cast<double>(i) << '\n';
  }
  const std::string in = directory.write("utm.pcd", text.str());
  const CloudTable input = readCloud(in);
  for (const std::string name : {"out.pcd", "out.ply"}) {
    const std::string out = directory.file(name);
    ASSERT_EQ(runProgram({"orient", in, out, "--quiet"}).status, 0);
    const CloudTable result = readCloud(out);
    ASSERT_EQ(result.size, input.size);
    std::size_t right = 0;
    for (std::size_t i = 0; i < input.size; ++i) {
      ASSERT_EQ(result.position(i), input.position(i));
      ASSERT_EQ(result.value(*result.find("intensity"), i), static_cast<double>(i));
      ASSERT_EQ(result.value(*result.find("time"), i), 1.6e9 + static_cast<double>(i));
      const auto n = result.triple(result.normals(), i);
      const auto t = source.triple(source.normals(), i);
      right += n[0] * t[0] + n[1] * t[1] + n[2] * t[2] > 0.0 ? 1 : 0;
    }
    EXPECT_GE(static_cast<double>(right), 0.995 * static_cast<double>(input.size));
  }
}

}  // namespace
}  // namespace segorient::test
