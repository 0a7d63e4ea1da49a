// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// check: right normals raise no alarm, patches that are turned over do, and are named.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "io/cloud_writer.h"
#include "io/readers.h"
#include "run_program.h"

namespace segorient::test {
namespace {

using program::CloudTable;

// Turns the normals of the rows that `choose` names.
void turn(const std::string& from, const std::string& to,
          const std::function<bool(const CloudTable&, std::size_t)>& choose) {
  CloudTable table = program::readCloud(from);
  for (std::size_t i = 0; i < table.size; ++i) {
    if (!choose(table, i)) continue;
    for (const program::Field* f : table.normals()) table.setReal(*f, i, -table.value(*f, i));
  }
  program::OutputCloud out(table);
  out.addRest(table);
  program::OutputFile file(to);
  writeCloud(out, file);
  file.commit();
}

struct Place {
  double points = 0.0;
  double center[3] = {0.0, 0.0, 0.0};
  std::string contradicts;
};

// The number behind the first "name": from a place in the text on.
double numberOf(const std::string& json, const std::string& name, std::size_t from) {
  const std::size_t at = json.find("\"" + name + "\":", from);
  return at == std::string::npos ? NAN : std::stod(json.substr(at + name.size() + 3));
}

Place firstPlace(const std::string& json) {
  Place out;
  const std::size_t from = json.find("\"places\"");
  out.points = numberOf(json, "points", from);
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) out.center[a] = numberOf(json, names[a], from);
  const std::size_t at = json.find("\"contradicts\"", from);
  const std::size_t begin = json.find('"', at + 14) + 1;
  out.contradicts = json.substr(begin, json.find('"', begin) - begin);
  return out;
}

// The shipped Fandisk oriented, which is right (another test measures that).
class CheckFandisk : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new ScratchDirectory;
    ASSERT_EQ(runProgram({"orient", fandisk(), directory_->file("good.ply"), "-q"}).status, 0);
  }
  static void TearDownTestSuite() { delete directory_; }
  static std::string file(const std::string& name) { return directory_->file(name); }

 private:
  static ScratchDirectory* directory_;
};
ScratchDirectory* CheckFandisk::directory_ = nullptr;

TEST_F(CheckFandisk, RightNormalsRaiseNoAlarm) {
  for (const std::string& path : {file("good.ply"), fandisk()}) {
    const Outcome run = runProgram({"check", path});
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_NE(run.out.find("0 (0.000 %) in 0 places"), std::string::npos) << run.out;
  }
}

TEST_F(CheckFandisk, OneSegmentTurnedOverIsNamed) {
  constexpr double kLabel = 2.0;
  double center[3] = {0.0, 0.0, 0.0};
  double count = 0.0;
  turn(file("good.ply"), file("turned.ply"), [&](const CloudTable& table, std::size_t i) {
    if (table.value(*table.find("label"), i) != kLabel) return false;
    for (std::size_t a = 0; a < 3; ++a) center[a] += table.position(i)[a];
    ++count;
    return true;
  });
  const Outcome run = runProgram({"check", file("turned.ply"), file("marked.pcd"), "--report",
                                  file("report.json"), "--picture", file("picture.png")});
  EXPECT_EQ(run.status, 3) << run.out << run.err;
  const std::string json = readFile(file("report.json"));
  const Place place = firstPlace(json);
  EXPECT_GT(place.points, 0.95 * count);
  EXPECT_LE(place.points, count);
  EXPECT_EQ(place.contradicts, "surface");
  const double extent = program::LocalPoints(program::readCloud(fandisk())).extent();
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(place.center[a], center[a] / count, 0.02 * extent);
  }
  EXPECT_NEAR(numberOf(json, "contradicting", 0), count, 0.05 * count) << "and nothing else";
  EXPECT_EQ(readFile(file("picture.png")).compare(1, 3, "PNG"), 0);
  // The marks are on the points of that segment.
  const CloudTable marked = program::readCloud(file("marked.pcd"));
  std::size_t right = 0;
  for (std::size_t i = 0; i < marked.size; ++i) {
    const bool mark = marked.value(*marked.find("contradiction"), i) != 0.0;
    const bool turned = marked.value(*marked.find("label"), i) == kLabel;
    EXPECT_TRUE(turned || !mark);
    if (mark == turned) ++right;
    EXPECT_EQ(mark, marked.value(*marked.find("place"), i) == 0.0);
  }
  EXPECT_GT(right, marked.size - static_cast<std::size_t>(0.05 * count));
}

TEST_F(CheckFandisk, InsideOutIsOne) {
  turn(file("good.ply"), file("inside.ply"), [](const CloudTable&, std::size_t) { return true; });
  ASSERT_EQ(runProgram({"check", file("inside.ply"), "-q", "--report", file("r.json")}).status, 3);
  const Place place = firstPlace(readFile(file("r.json")));
  EXPECT_EQ(place.contradicts, "inside_out");
  EXPECT_GT(place.points, 16000.0);
}

// Single normals, one in fifty, are noise and no place.
TEST_F(CheckFandisk, SinglePointsAreNone) {
  turn(file("good.ply"), file("noise.ply"),
       [](const CloudTable&, std::size_t i) { return i % 50 == 0; });
  const Outcome run = runProgram({"check", file("noise.ply")});
  EXPECT_EQ(run.status, 0) << run.out;
}

// A flat square seen from above has no inside, but a sensor.
TEST(Check, SensorsTellTheSideOfAnOpenSurface) {
  const ScratchDirectory directory;
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nproperty float y\nproperty "
          "float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float "
          "vp_x\nproperty float vp_y\nproperty float vp_z\nproperty int scan\nend_header\n";
  for (int i = 0; i < 900; ++i) {
    const int down = i < 450 ? 1 : -1;  // half of it, scan 1, turns its back to its sensor
    text << i / 30 << ' ' << i % 30 << ' ' << 0.01 * (i * 7 % 5) << " 0 0 " << down << " 15 15 40 "
         << (i < 450 ? 0 : 1) << "\n";
  }
  const std::string path = directory.write("square.ply", text.str());
  const Outcome run = runProgram({"check", path, "--report", directory.file("r.json")});
  EXPECT_EQ(run.status, 3) << run.out << run.err;
  const std::string json = readFile(directory.file("r.json"));
  EXPECT_EQ(firstPlace(json).contradicts, "sensor");
  EXPECT_NEAR(firstPlace(json).points, 450.0, 5.0);
  EXPECT_NE(run.out.find("scan 1"), std::string::npos) << run.out;
  EXPECT_EQ(numberOf(json, "scan", json.find("\"places\"")), 1.0);
}

TEST(Check, UsageAndInputWithoutNormals) {
  const ScratchDirectory directory;
  const std::string bare = directory.write("bare.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_EQ(runProgram({"check", bare}).status, 1);
  EXPECT_EQ(runProgram({"check"}).status, 2);
  EXPECT_EQ(runProgram({"check", fandisk(), directory.file("a.txt")}).status, 2);
  EXPECT_EQ(runProgram({"check", fandisk(), "--keep-orientation"}).status, 2);
  EXPECT_EQ(runProgram({"check", fandisk(), "--picture", directory.file("a.jpg")}).status, 2);
  const std::string few = directory.write("few.xyz", "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n");
  EXPECT_EQ(runProgram({"check", few}).status, 0) << "nothing to judge is nothing at fault";
  const auto withNormals = [&](const char* name, const char* first) {
    return directory.write(name, std::string("ply\nformat ascii 1.0\nelement vertex 3\n") +
                                     "property float x\nproperty float y\nproperty float z\n" +
                                     "property float nx\nproperty float ny\nproperty float nz\n" +
                                     "end_header\n0 0 0 " + first + "\n1 0 0 0 0 0\n0 1 0 0 0 0\n");
  };
  const std::string none = withNormals("none.ply", "0 0 0");
  const Outcome run = runProgram({"check", none, directory.file("out.ply")});
  EXPECT_EQ(run.status, 1) << "none contradicts would be said of nothing";
  EXPECT_NE(run.err.find("all are zero"), std::string::npos) << run.err;
  EXPECT_EQ(directory.entries(), 3U);
  EXPECT_EQ(runProgram({"check", withNormals("one.ply", "0 0 1")}).status, 0) << "one is there";
}

}  // namespace
}  // namespace segorient::test
