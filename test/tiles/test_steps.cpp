// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Clouds tile by tile, through the program.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "run_program.h"
#include "tile_clouds.h"

namespace segorient::test {
namespace {

namespace fs = std::filesystem;

void expectRuns(const std::vector<std::string>& words) {
  const Outcome run = runProgram(words);
  ASSERT_EQ(run.status, 0) << run.err;
}

// Points with the same normal to within .8 degrees.
std::size_t sameNormals(const std::string& a, const std::string& b) {
  const program::CloudTable one = program::readCloud(a);
  const program::CloudTable other = program::readCloud(b);
  std::size_t same = 0;
  for (std::size_t i = 0; i < one.size; ++i) {
    const auto n = one.triple(one.normals(), i);
    const auto m = other.triple(other.normals(), i);
    same += n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.9999 ? 1 : 0;
  }
  return same;
}

TEST(Tiles, SignsAreThoseOfTheWholeForAnySizeOfTiles) {
  const ScratchDirectory scratch;
  const std::string whole = scratch.file("whole.ply");
  const std::string tiled = scratch.file("tiled.ply");
  expectRuns({"orient", fandisk(), whole, "-q"});
  const std::size_t points = program::readCloud(whole).size;
  for (const char* most : {"3000", "7000"}) {
    expectRuns({"orient", fandisk(), tiled, "-q", "--memory", "1G", "--tile-points", most});
    EXPECT_EQ(sameSides(whole, tiled), points) << most;
  }
  EXPECT_EQ(scratch.entries(), 2U) << "the work folders are still there";
}

// No tile sees that it is a closed body, nor which of its walls is a cavity's. At the size of UTM
// coordinates, where floats have steps of half a metre.
TEST(Tiles, AClosedBodyLargerThanAnyTileEndsOutwardAndItsCavityToo) {
  const ScratchDirectory scratch;
  const double middle[3] = {500000.125, 5400000.5, 312.25};
  const std::string in =
      writeDoubles(scratch.file("in.ply"), hollowSphere(20000, middle[0], middle[1], middle[2]));
  const std::string out = scratch.file("out.ply");
  expectRuns({"orient", in, out, "-q", "--memory", "1G", "--tile-points", "3000"});
  const program::CloudTable cloud = program::readCloud(out);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const auto p = cloud.position(i);
    const auto n = cloud.triple(cloud.normals(), i);
    double outward = i % 5 == 4 ? -1.0 : 1.0;
    double dot = 0.0;
    for (std::size_t a = 0; a < 3; ++a) dot += n[a] * (p[a] - middle[a]);
    wrong += outward * dot > 0.0 ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0U);
}

// Any order, any number of threads, each step twice: the same bytes as all in one.
TEST(Tiles, StepsOneByOneGiveTheBytesOfTheCommand) {
  const ScratchDirectory scratch;
  const std::string at_once = scratch.file("once.ply");
  const std::string by_steps = scratch.file("steps.ply");
  const std::string folder = scratch.file("work");
  const std::vector<std::string> how{"--memory", "1G", "--tile-points", "5000"};
  std::vector<std::string> words{"orient", fandisk(), at_once, "-q"};
  words.insert(words.end(), how.begin(), how.end());
  expectRuns(words);
  words = {"tiles", "plan", folder, fandisk(), by_steps};
  words.insert(words.end(), how.begin(), how.end());
  const Outcome plan = runProgram(words);
  ASSERT_EQ(plan.status, 0) << plan.err;
  EXPECT_EQ(plan.out, runProgram(words).out);
  ASSERT_EQ(plan.out.rfind("tiles 4\n", 0), 0U) << plan.out;
  for (const char* tile : {"2", "0", "3"}) {
    expectRuns({"tiles", "tile", folder, tile, "--threads", "1"});
  }
  const Outcome early = runProgram({"tiles", "join", folder});
  EXPECT_EQ(early.status, 1);
  EXPECT_TRUE(isOneLine(early.err)) << early.err;
  EXPECT_EQ(runProgram({"tiles", "tile", folder, "4"}).status, 2);
  expectRuns({"tiles", "tile", folder});
  for (int i = 0; i < 2; ++i) {
    const Outcome join = runProgram({"tiles", "join", folder});
    EXPECT_EQ(join.status, 0) << join.err;
    EXPECT_EQ(join.out, "") << "a smooth body whose tiles know their signs";
    expectRuns({"tiles", "write", folder});
    EXPECT_TRUE(readFile(at_once) == readFile(by_steps));
  }
}

TEST(Tiles, AFolderOfInputsGetsAFolderOfOutputs) {
  const ScratchDirectory scratch;
  fs::create_directory(scratch.file("in"));
  fs::create_directory(scratch.file("out"));
  const std::vector<double> body = hollowSphere(9000, 0.0, 0.0, 0.0);
  const auto half = static_cast<std::ptrdiff_t>(body.size() / 2 / 3 * 3);
  writeDoubles(scratch.file("in/a.ply"), {body.begin(), body.begin() + half});
  writeDoubles(scratch.file("in/b.ply"), {body.begin() + half, body.end()});
  const std::string all = writeDoubles(scratch.file("all.ply"), body);
  const std::vector<std::string> how{"-q", "--memory", "1G", "--tile-points", "2500"};
  std::vector<std::string> words{"orient", scratch.file("in"), scratch.file("out")};
  words.insert(words.end(), how.begin(), how.end());
  expectRuns(words);
  words = {"orient", all, scratch.file("one.ply")};
  words.insert(words.end(), how.begin(), how.end());
  expectRuns(words);
  const program::CloudTable one = program::readCloud(scratch.file("one.ply"));
  std::size_t row = 0;
  for (const char* name : {"out/a.ply", "out/b.ply"}) {
    const program::CloudTable part = program::readCloud(scratch.file(name));
    for (std::size_t i = 0; i < part.size; ++i, ++row) {
      ASSERT_EQ(part.triple(part.normals(), i), one.triple(one.normals(), row)) << name << i;
    }
  }
  EXPECT_EQ(row, one.size);
}

// Text can't be read from the middle; three points and a thousand in one place have no surface.
TEST(Tiles, OddCloudsAreOrientedOrGetNaN) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out.pcd");
  const std::string text = scratch.write("three.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  const std::string place = writeDoubles(scratch.file("place.ply"), std::vector<double>(3000, 1.5));
  std::vector<double> gaps = hollowSphere(6000, 0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < gaps.size(); i += 300) gaps[i] = std::nan("");
  for (const std::string& in : {text, place, writeDoubles(scratch.file("gaps.ply"), gaps)}) {
    const Outcome run =
        runProgram({"orient", in, out, "-q", "--memory", "1G", "--tile-points", "500"});
    EXPECT_EQ(run.status, 0) << run.err;
    const program::CloudTable cloud = program::readCloud(out);
    EXPECT_EQ(cloud.size, program::readCloud(in).size);
    std::size_t with_normal = 0;
    for (std::size_t i = 0; i < cloud.size; ++i) {
      with_normal += std::isfinite(cloud.triple(cloud.normals(), i)[0]) ? 1 : 0;
    }
    const bool surface = in == scratch.file("gaps.ply");
    EXPECT_EQ(with_normal, surface ? 5940U : (in == text ? with_normal : 0U)) << in;
  }
}

// A survey with one return at 0,0,0: neither tiles nor their coordinates are laid out for that.
TEST(Tiles, AFewStraysChangeNothing) {
  const ScratchDirectory scratch;
  const std::string whole = scratch.file("whole.ply");
  const std::string tiled = scratch.file("tiled.ply");
  for (const double stray : {0.0, 1e7, 1e20}) {
    std::vector<double> body = hollowSphere(6000, 456123.0, 5412345.0, 312.0);
    std::fill_n(&body[15], 3, stray);
    const std::string in = writeDoubles(scratch.file("in.ply"), body);
    expectRuns({"orient", in, whole, "-q"});
    for (const char* points : {"20000", "2000"}) {
      expectRuns({"orient", in, tiled, "-q", "--memory", "1G", "--tile-points", points});
      EXPECT_GE(sameSides(whole, tiled), 5998U) << stray << ", " << points;
    }
  }
}

TEST(Tiles, AnOrganisedCloudStaysOne) {
  const ScratchDirectory scratch;
  std::string text = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 60\nHEIGHT 50\nDATA ascii\n";
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 60; ++column) {
      text += std::to_string(0.01 * column) + ' ' + std::to_string(0.01 * row) + " 1\n";
    }
  }
  // As text it is copied first, as the output is not.
  std::string in = scratch.write("in.pcd", text);
  for (const char* name : {"first.pcd", "second.pcd"}) {
    const std::string out = scratch.file(name);
    expectRuns({"orient", in, out, "-q", "--memory", "1G", "--tile-points", "2000"});
    const program::CloudTable table = program::readCloud(out);
    EXPECT_EQ(table.width, 60U) << name;
    EXPECT_EQ(table.height, 50U) << name;
    in = out;
  }
}

// A cloud without points is one all the same; hidden files and notes are none.
TEST(Tiles, AFolderMayHoldEmptyCloudsAndOtherFiles) {
  const ScratchDirectory scratch;
  fs::create_directory(scratch.file("in"));
  fs::create_directory(scratch.file("out"));
  writeDoubles(scratch.file("in/a.ply"), hollowSphere(3000, 0.0, 0.0, 0.0));
  writeDoubles(scratch.file("in/b.ply"), {});
  scratch.write("in/readme.txt", "These are clouds.\n");
  scratch.write("in/.c.ply", "no cloud");
  expectRuns({"orient", scratch.file("in"), scratch.file("out"), "-q", "--memory", "1G"});
  EXPECT_EQ(program::readCloud(scratch.file("out/a.ply")).size, 3000U);
  const std::string none = readFile(scratch.file("out/b.ply"));
  EXPECT_NE(none.find("element vertex 0\n"), std::string::npos) << none;
  EXPECT_NE(none.find("property float nx\n"), std::string::npos) << none;
  EXPECT_FALSE(fs::exists(scratch.file("out/readme.txt")));
}

// What borders say of bodies in contact leads astray; the winding number of all points does not.
TEST(Tiles, BodiesInContactHaveTheSidesOfTheWhole) {
  const ScratchDirectory scratch;
  const std::string in = writeDoubles(scratch.file("in.ply"), stackOfBoxes(4, 6000));
  const std::string whole = scratch.file("whole.ply");
  const std::string tiled = scratch.file("tiled.ply");
  expectRuns({"orient", in, whole, "-q"});
  expectRuns({"orient", in, tiled, "-q", "--memory", "1G", "--tile-points", "5000"});
  // Faces in contact, a quarter of all, have no side.
  EXPECT_GT(sameSides(whole, tiled), 23000U);
}

// In noise, normals follow the field of all points.
TEST(Tiles, NormalsInNoiseAreThoseOfTheWhole) {
  const ScratchDirectory scratch;
  std::vector<double> body = hollowSphere(12000, 0.0, 0.0, 0.0);
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0.0, 0.015);
  for (double& x : body) x += noise(engine);
  const std::string in = writeDoubles(scratch.file("in.ply"), body);
  expectRuns({"orient", in, scratch.file("whole.ply"), "-q"});
  expectRuns(
      {"orient", in, scratch.file("tiled.ply"), "-q", "--memory", "1G", "--tile-points", "4000"});
  EXPECT_GT(sameNormals(scratch.file("whole.ply"), scratch.file("tiled.ply")), 11900U);
}

// Bumps seen by lines twelve times as far apart as their points: that there are lines is a property
// of the whole.
TEST(Tiles, NormalsAcrossScanLinesAreThoseOfTheWhole) {
  const ScratchDirectory scratch;
  std::mt19937 engine(6);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  std::vector<double> lines;
  for (int line = 0; line < 20; ++line) {
    for (int i = 0; i < 800; ++i) {
      const double x = (i + shift(engine)) / 800.0;
      const double y = 12.0 * line / 800.0;
      lines.insert(lines.end(), {x, y, 0.01 * std::sin(6.0 * M_PI * x) * std::cos(6.0 * M_PI * y)});
    }
  }
  const std::string in = writeDoubles(scratch.file("in.ply"), lines);
  expectRuns({"orient", in, scratch.file("whole.ply"), "-q"});
  expectRuns(
      {"orient", in, scratch.file("tiled.ply"), "-q", "--memory", "1G", "--tile-points", "4000"});
  EXPECT_GT(sameNormals(scratch.file("whole.ply"), scratch.file("tiled.ply")), 15900U);
}

// Two and a half turns, six spacings apart, in noise of .7: the field of all points wants the
// inmost turn the other way, which would tear the sheet where only some tiles see it.
TEST(Tiles, ARollInNoiseStaysOneSheet) {
  const ScratchDirectory scratch;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> gauss;
  constexpr std::size_t kPoints = 12000;
  const double spacing = std::sqrt(12.0 / kPoints);
  const double growth = 6.0 * spacing / (2.0 * M_PI);
  const auto radius = [&](double turn) { return 0.35 + growth * turn; };
  std::vector<double> xyz;
  while (xyz.size() < 3 * kPoints) {
    const double t = 5.0 * M_PI * uniform(random);
    if (uniform(random) * radius(5.0 * M_PI) > radius(t)) continue;  // even over the sheet
    const double p[3] = {radius(t) * std::cos(t), radius(t) * std::sin(t), 1.5 * uniform(random)};
    for (const double x : p) xyz.push_back(x + 0.7 * spacing * gauss(random));
  }
  const std::string in = writeDoubles(scratch.file("in.ply"), xyz);
  const std::string whole = scratch.file("whole.ply");
  const std::string tiled = scratch.file("tiled.ply");
  expectRuns({"orient", in, whole, "-q"});
  expectRuns({"orient", in, tiled, "-q", "--memory", "1G", "--tile-points", "3000"});
  EXPECT_GE(sameSides(whole, tiled), kPoints - kPoints / 1000);
}

TEST(Tiles, WhatDoesNotGoWithTilesIsWrongUsage) {
  const ScratchDirectory scratch;
  const std::string out = scratch.file("out.ply");
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--memory", "x"},
                                             {"--memory", "1M"},
                                             {"--memory", "1G", "--method", "hoppe"},
                                             {"--memory", "1G", "--report", out}}) {
    std::vector<std::string> words{"orient", fandisk(), out};
    words.insert(words.end(), wrong.begin(), wrong.end());
    const Outcome run = runProgram(words);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
  }
  EXPECT_EQ(runProgram({"orient", fandisk(), scratch.file("out.obj"), "--memory", "1G"}).status, 2);
  EXPECT_EQ(scratch.entries(), 0U);
}

// Two scans of a body that lie apart by most of a spacing: signs come from a coarser scale, which
// the plan chooses for all tiles. At the points' own scale a third of them are wrong.
TEST(Tiles, LayersTakeTheSignsOfACoarserScale) {
  const ScratchDirectory scratch;
  constexpr std::size_t kPoints = 12000;
  std::mt19937 random(11);
  std::normal_distribution<double> gauss;
  std::vector<double> xyz;
  for (std::size_t i = 0; i < kPoints; ++i) {
    double p[3] = {gauss(random), gauss(random), gauss(random)};
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const double spacing = std::sqrt(4.0 * 3.14159265 / kPoints);
    const double shift = i % 2 == 0 ? 0.0 : 1.2 * spacing;
    for (int a = 0; a < 3; ++a) p[a] = p[a] / length * (a == 2 ? 0.7 : 1.0);
    xyz.insert(xyz.end(), {p[0] + shift, p[1] + 0.5 * shift, p[2]});
  }
  const std::string in = writeDoubles(scratch.file("in.ply"), xyz);
  const std::string tiled = scratch.file("tiled.ply");
  expectRuns({"orient", in, tiled, "-q", "--memory", "1G", "--tile-points", "3000"});
  const program::CloudTable cloud = program::readCloud(tiled);
  std::size_t outward = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto n = cloud.triple(cloud.normals(), i);
    const auto p = cloud.position(i);
    outward += n[0] * p[0] + n[1] * p[1] + n[2] * p[2] > 0.0 ? 1 : 0;
  }
  EXPECT_GE(outward, kPoints - kPoints / 100);
  const std::string whole = scratch.file("whole.ply");
  expectRuns({"orient", in, whole, "-q"});
  EXPECT_GE(sameSides(whole, tiled), kPoints - kPoints / 1000);
}

}  // namespace
}  // namespace segorient::test
