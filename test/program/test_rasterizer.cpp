// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Pictures must show a wrong patch, and must not show one where there is none.
#include <gtest/gtest.h>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "io/errors.h"
#include "io/readers.h"
#include "render/scene.h"
#include "scratch_directory.h"
#include "support/colors.h"
#include "support/report_facts.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::Picture;

// Points of the unit sphere; normals of those above `cap` point inward.
CloudTable sphere(const ScratchDirectory& directory, double cap) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  std::ostringstream text;
  text.precision(9);
  for (int i = 0; i < 20000; ++i) {
    double p[3] = {gauss(random), gauss(random), gauss(random)};
    const double length = std::hypot(p[0], p[1], p[2]);
    for (double& v : p) v /= length;
    const double sign = p[2] > cap ? -1.0 : 1.0;
    text << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << sign * p[0] << ' ' << sign * p[1] << ' '
         << sign * p[2] << '\n';
  }
  return program::readCloud(directory.write("sphere.xyz", text.str()));
}

// Shares of the drawn pixels that are red, and of all pixels that are drawn.
struct Shares {
  double red = 0.0;
  double drawn = 0.0;
};

Shares shares(const Picture& picture) {
  std::size_t red = 0;
  std::size_t drawn = 0;
  const std::size_t size = picture.width * picture.height;
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint8_t* p = picture.rgb.data() + 3 * i;
    if (p[0] == 255 && p[1] == 255 && p[2] == 255) continue;
    ++drawn;
    if (p[0] > 2 * p[1]) ++red;
  }
  return {static_cast<double>(red) / static_cast<double>(drawn),
          static_cast<double>(drawn) / static_cast<double>(size)};
}

Shares draw(const CloudTable& table, double elevation) {
  const program::LocalPoints points(table);
  program::View view;
  view.width = view.height = 400;
  view.elevation = elevation;
  return shares(program::drawScene(
      program::makeScene(table, points, nullptr, program::Coloring::Normal, 1), view));
}

TEST(Rasterizer, AnOutwardSphereIsAFullDiscWithoutRed) {
  const ScratchDirectory directory;
  const CloudTable table = sphere(directory, 2.0);
  const Shares s = draw(table, 25.0);
  // A circle in a square with 4 % margins.
  EXPECT_NEAR(s.drawn, 0.25 * M_PI * 0.92 * 0.92, 0.02);
  EXPECT_LT(s.red, 0.005);
}

TEST(Rasterizer, AWrongPatchIsRedFromItsSideAndHiddenFromTheOther) {
  const ScratchDirectory directory;
  const CloudTable table =
      sphere(directory, 0.8);  // a cap of radius 0.6: 36 % of the disc seen above
  EXPECT_NEAR(draw(table, 90.0).red, 0.36, 0.03);
  EXPECT_LT(draw(table, -90.0).red, 0.005);
}

// A labelled sphere: the upper half is segment 0, of which a cap is turned over; below is
// segment 1.
TEST(Rasterizer, OrientationShowsSegmentsWrongPatchesAndHardOnes) {
  const ScratchDirectory directory;
  std::mt19937 random(4);
  std::normal_distribution<double> gauss;
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex 8000\nproperty float x\nproperty float y\n"
          "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
          "property uint label\nend_header\n";
  for (int i = 0; i < 8000; ++i) {
    double p[3] = {gauss(random), gauss(random), gauss(random)};
    const double length = std::hypot(p[0], p[1], p[2]);
    for (double& v : p) v /= length;
    const double sign = p[2] > 0.8 ? -1.0 : 1.0;
    text << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << sign * p[0] << ' ' << sign * p[1] << ' '
         << sign * p[2] << ' ' << (p[2] > 0.0 ? 0 : 1) << '\n';
  }
  const std::string path = directory.write("sphere.ply", text.str());
  const CloudTable table = program::readCloud(path);
  const program::Coloring coloring = program::parseColoring("orientation", table, path);
  const program::LocalPoints points(table);
  program::View view;
  view.width = view.height = 300;
  const auto violet = [&](const std::vector<std::uint32_t>& hard, double elevation) {
    view.elevation = elevation;
    program::Facts facts;
    facts.segments.resize(2);
    for (const std::uint32_t label : hard) facts.segments[label].hard = true;
    const Picture picture =
        program::drawScene(program::makeScene(table, points, nullptr, coloring, 1, facts), view);
    std::size_t count = 0;
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
      const std::uint8_t* p = picture.rgb.data() + i;
      drawn += p[0] == 255 && p[1] == 255 && p[2] == 255 ? 0 : 1;
      count += 2 * p[1] < p[2] && p[0] < p[2] ? 1 : 0;
    }
    if (hard.empty()) {
      EXPECT_NEAR(shares(picture).red, elevation > 0 ? 0.36 : 0.0, 0.04);
    }
    return static_cast<double>(count) / static_cast<double>(drawn);
  };
  EXPECT_LT(violet({}, 90.0), 0.01);
  EXPECT_LT(violet({}, -90.0), 0.01);
  EXPECT_GT(violet({0}, 90.0), 0.95);
  EXPECT_LT(violet({0}, -90.0), 0.05);
  EXPECT_GT(violet({0, 1}, -90.0), 0.95);
}

TEST(Rasterizer, AMeshShowsItsFrontAndItsBack) {
  const ScratchDirectory directory;
  // In the plane x = 0, its front towards +x.
  const CloudTable table = program::readCloud(directory.write(
      "triangle.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n0 1 0\n0 0 1\n3 0 1 2\n"));
  const program::LocalPoints points(table);
  const program::Scene scene =
      program::makeScene(table, points, nullptr, program::Coloring::Normal, 1);
  program::View view;
  view.elevation = 0.0;
  view.azimuth = 0.0;
  EXPECT_EQ(shares(program::drawScene(scene, view)).red, 0.0);
  view.azimuth = 180.0;
  const Shares behind = shares(program::drawScene(scene, view));
  EXPECT_NEAR(behind.drawn, 0.5 * 0.92 * 0.92, 0.02);
  EXPECT_GT(behind.red, 0.95);
}

TEST(Rasterizer, EveryDegenerateCloudGivesAPicture) {
  const ScratchDirectory directory;
  for (const std::string text :
       {"0 0 0\n", "1 1 1\n1 1 1\n", "0 0 0\n1e30 0 0\n", "0 0 0\n1e-40 0 0\n",
        "nan 0 0\n0 0 0\n1 0 inf\n", "0 0 0 0 0 0\n1 0 0 0 0 0\n"}) {
    const CloudTable table = program::readCloud(directory.write("a.xyz", text));
    const program::LocalPoints points(table);
    const Picture picture =
        program::drawViews(program::makeScene(table, points, nullptr, program::Coloring::Rgb, 1),
                           program::View{}, true);
    EXPECT_EQ(picture.width, 800U) << text;
  }
}

// Found by UndefinedBehaviorSanitizer: sums of the largest floats overflow.
TEST(Rasterizer, CornersOfAllFloatsAreDrawnAsThoseOfAnyCube) {
  const auto cube = [](float scale) {
    program::Scene scene;
    for (int i = 0; i < 8; ++i) {
      program::Splat s;
      s.position = {(i & 1) != 0 ? scale : -scale, (i & 2) != 0 ? scale : -scale,
                    (i & 4) != 0 ? scale : -scale};
      s.normal = {NAN, NAN, NAN};
      s.front = s.back = 0xff0000U;
      scene.splats.push_back(s);
    }
    return program::drawScene(scene, program::View{});
  };
  const Picture expected = cube(1.99F);
  EXPECT_GT(shares(expected).drawn, 0.0);
  EXPECT_EQ(cube(std::ldexp(1.99F, 127)).rgb, expected.rgb);
}

TEST(Rasterizer, PointsFartherApartThanFloatsCanSquareAreDots) {
  const ScratchDirectory directory;
  const CloudTable table = program::readCloud(
      directory.write("far.xyz", "-3e38 -3e38 -3e38\n3e38 3e38 3e38\n3e38 -3e38 0\n"));
  const program::LocalPoints points(table);
  const Picture picture = program::drawScene(
      program::makeScene(table, points, nullptr, program::Coloring::Rgb, 1), program::View{});
  EXPECT_LT(shares(picture).drawn, 0.01);
}

TEST(Report, TellsSegmentsAndContradictions) {
  const ScratchDirectory directory;
  const program::Facts facts = program::readReport(directory.write(
      "a.json",
      "{\"components\": [{\"oriented_by\": \"global\"}], \"contradictions\": [{\"x\": 1, \"y\": 2,"
      " \"z\": 3.5}], \"segments\": [{\"label\": 0, \"kind\": \"regular\", \"confidence\": 0.25,"
      " \"oriented_by\": \"seed\", \"component\": 0}, {\"label\": 99}], \"hard_segments\": [ 4 "
      "]}"));
  ASSERT_EQ(facts.segments.size(), 5U);
  EXPECT_FLOAT_EQ(facts.segments[0].confidence, 0.25F);
  EXPECT_EQ(facts.segments[0].component_by, "global");
  EXPECT_LT(facts.segments[1].confidence, 0.F);
  EXPECT_TRUE(facts.segments[4].hard && !facts.segments[0].hard);
  EXPECT_EQ(facts.contradictions, (std::vector<std::array<double, 3>>{{1.0, 2.0, 3.5}}));
  for (const std::string text :
       {"", "{}", "[1, 2]", "{\"hard_segments\": [\"x\"]}", "{\"hard_segments\": [-1]}", "{",
        "{\"hard_segments\": [], \"contradictions\": [{\"x\": 1}]}"}) {
    EXPECT_THROW(program::readReport(directory.write("b.json", text)), program::FileError) << text;
  }
  EXPECT_THROW(program::readReport(directory.file("none.json")), program::FileError);
}

TEST(Sensors, AreReadFromJsonOrACloud) {
  const ScratchDirectory directory;
  const std::vector<std::array<double, 3>> expected{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  EXPECT_EQ(
      program::readSensors(directory.write(
          "a.json", "{\"sensors\": [{\"x\": 1, \"y\": 2, \"z\": 3}, {\"position\": [4, 5, 6]}]}")),
      expected);
  EXPECT_EQ(program::readSensors(directory.write("a.xyz", "1 2 3\n4 5 6\n")), expected);
  std::size_t explained = 0;
  program::readSensors(
      directory.write("c.json",
                      R"({"sensors": [{"x": 1, "y": 2, "z": 3, "points": 7, "sure": true},)"
                      R"({"x": 1, "y": 2, "z": 3, "points": 5, "sure": false}]})"),
      &explained);
  EXPECT_EQ(explained, 7U);
  for (const std::string text : {"", "{}", "{\"sensors\": [{\"position\": [1, 2]}]}",
                                 "{\"sensors\": [{\"x\": 1, \"y\": \"nan\", \"z\": 2}]}"}) {
    EXPECT_THROW(program::readSensors(directory.write("b.json", text)), program::FileError) << text;
  }
}

TEST(Colors, SegmentsNextInNumberAreFarApart) {
  EXPECT_EQ(program::segmentColor(program::kNoSegment), 0x909090U);
  for (std::uint32_t label = 0; label < 500; ++label) {
    for (std::uint32_t other = label + 1; other < label + 6; ++other) {
      int difference = 0;
      for (const unsigned shift : {0U, 8U, 16U}) {
        difference += std::abs(static_cast<int>(program::segmentColor(label) >> shift & 255U) -
                               static_cast<int>(program::segmentColor(other) >> shift & 255U));
      }
      EXPECT_GT(difference, 60) << label << " and " << other;
    }
  }
}

}  // namespace
}  // namespace segorient::test
