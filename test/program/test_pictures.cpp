// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// A cloud that is right has no red in any picture, and a face that is turned over is red.
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <cmath>
#include <random>

#include "io/readers.h"
#include "render/legend.h"
#include "render/page/disc_radii.h"
#include "render/page/sides.h"
#include "render/page/thinning.h"
#include "render/palette.h"
#include "render/scene.h"
#include "scratch_directory.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::LocalPoints;
using program::Picture;

struct Vertex {
  double p[3];
  double n[3];
};

// Random points of a box of 1 by 0.7 by `height` with noise along their normals.
std::vector<Vertex> box(int count, double noise, double height = 0.4) {
  const double side[3] = {1.0, 0.7, height};
  const double whole = 2.0 * (0.7 + 1.7 * height);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit;
  std::normal_distribution<double> gauss;
  std::vector<Vertex> out;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double area = side[(axis + 1) % 3] * side[(axis + 2) % 3];
    for (int i = 0; i < count * area / whole; ++i) {
      Vertex v{};
      for (int a = 0; a < 3; ++a) v.p[a] = side[a] * unit(random);
      v.n[axis] = face % 2 == 0 ? -1.0 : 1.0;
      v.p[axis] = (face % 2 == 0 ? 0.0 : side[axis]) + noise * gauss(random) * v.n[axis];
      out.push_back(v);
    }
  }
  return out;
}

CloudTable tableOf(const ScratchDirectory& directory, const std::vector<Vertex>& points) {
  std::ostringstream text;
  text.precision(9);
  for (const Vertex& v : points) {
    text << v.p[0] << ' ' << v.p[1] << ' ' << v.p[2] << ' ' << v.n[0] << ' ' << v.n[1] << ' '
         << v.n[2] << '\n';
  }
  return program::readCloud(directory.write("cloud.xyz", text.str()));
}

bool isRed(const std::uint8_t* p) {
  return p[0] > p[1] + 25 && p[0] > p[2] + 25;
}

std::size_t redPixels(const Picture& picture) {
  std::size_t red = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) red += isRed(&picture.rgb[i]) ? 1 : 0;
  return red;
}

Picture draw(const CloudTable& table, double azimuth, double elevation, int threads = 2,
             program::Coloring coloring = program::Coloring::Normal) {
  const LocalPoints points(table);
  program::View view;
  view.width = view.height = 300;
  view.azimuth = azimuth;
  view.elevation = elevation;
  view.threads = threads;
  return program::drawScene(program::makeScene(table, points, nullptr, coloring, threads), view);
}

std::size_t redFromAllSides(const CloudTable& table) {
  std::size_t red = 0;
  for (const double elevation : {-60.0, -20.0, 20.0, 60.0}) {
    for (const double azimuth : {20.0, 140.0, 260.0}) {
      red += redPixels(draw(table, azimuth, elevation));
    }
  }
  return red;
}

// Who is nearest counts; what faces none is wrong; else it is for others to tell.
TEST(Pictures, SidesByTheSensorsThatSomebodyNames) {
  const ScratchDirectory directory;
  const CloudTable table = tableOf(directory, {{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}});
  program::Facts facts;
  facts.sensors = {{0.0, 0.0, 2.0}, {0.0, 0.0, -5.0}};
  EXPECT_FALSE(program::PointSensors(table, facts).any()) << "need not have seen it";
  facts.saw_all = true;
  const program::PointSensors sensors(table, facts);
  EXPECT_TRUE(sensors.any());
  EXPECT_EQ(sensors.side(0, {0.F, 0.F, 1.F}, program::Side::Open), program::Side::Outer);
  EXPECT_EQ(sensors.side(0, {0.F, 0.F, -1.F}, program::Side::Open), program::Side::Open);
  EXPECT_EQ(sensors.side(0, {1.F, 0.F, 0.F}, program::Side::Open), program::Side::Outer);
  facts.sensors = {{0.0, 0.0, 2.0}, {0.0, 1.0, 5.0}};
  EXPECT_EQ(program::PointSensors(table, facts).side(0, {0.F, 0.F, -1.F}, program::Side::Open),
            program::Side::Contrary);
}

TEST(Pictures, ACloudThatIsRightHasNoRedFromAnySide) {
  const ScratchDirectory directory;
  EXPECT_EQ(redFromAllSides(tableOf(directory, box(6000, 0.0))), 0U) << "sharp edges";
  // Points are 0.02 apart.
  EXPECT_EQ(redFromAllSides(tableOf(directory, box(6000, 0.01))), 0U) << "noise";
}

TEST(Pictures, RoundAndThinSurfacesThatAreRightHaveNoRed) {
  const ScratchDirectory directory;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * M_PI);
  std::vector<Vertex> torus;
  for (int i = 0; i < 6000; ++i) {
    const double u = turn(random);
    const double v = turn(random);
    const double c = std::cos(v);
    torus.push_back({{(1 + 0.3 * c) * std::cos(u), (1 + 0.3 * c) * std::sin(u), 0.3 * std::sin(v)},
                     {c * std::cos(u), c * std::sin(u), std::sin(v)}});
  }
  EXPECT_EQ(redFromAllSides(tableOf(directory, torus)), 0U);
  // A plate of two spacings.
  EXPECT_EQ(redFromAllSides(tableOf(directory, box(6000, 0.0, 0.032))), 0U);
}

TEST(Pictures, AFaceTurnedOverIsRedToItsEdges) {
  const ScratchDirectory directory;
  std::vector<Vertex> points = box(6000, 0.0);
  for (Vertex& v : points) v.n[2] = -std::abs(v.n[2]);  // the upper face
  const Picture picture = draw(tableOf(directory, points), 35.0, 40.0);
  // Where the upper face is, computed from the view: what lies on z = 0.4.
  const double a = 35.0 * M_PI / 180.0;
  const double e = 40.0 * M_PI / 180.0;
  double low[2] = {1e9, 1e9};
  double high[2] = {-1e9, -1e9};
  const auto flat = [&](const double* p, double* out) {
    out[0] = -std::sin(a) * p[0] + std::cos(a) * p[1];
    out[1] = std::sin(e) * (std::cos(a) * p[0] + std::sin(a) * p[1]) - std::cos(e) * p[2];
  };
  for (const Vertex& v : points) {
    double d[2];
    flat(v.p, d);
    for (int k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], d[k]);
      high[k] = std::max(high[k], d[k]);
    }
  }
  const double scale = 300.0 * 0.92 / std::max(high[0] - low[0], high[1] - low[1]);
  std::size_t red = 0;
  std::size_t all = 0;
  for (int i = 1; i < 100; ++i) {
    for (int j = 1; j < 100; ++j) {
      const double p[3] = {0.01 * i, 0.007 * j, 0.4};
      double d[2];
      flat(p, d);
      const auto x = static_cast<std::size_t>(150.0 + scale * (d[0] - 0.5 * (low[0] + high[0])));
      const auto y = static_cast<std::size_t>(150.0 + scale * (d[1] - 0.5 * (low[1] + high[1])));
      ++all;
      red += isRed(&picture.rgb[3 * (300 * y + x)]) ? 1 : 0;
    }
  }
  EXPECT_GT(static_cast<double>(red) / static_cast<double>(all), 0.95);
}

TEST(Pictures, DoNotDependOnTheNumberOfThreads) {
  const ScratchDirectory directory;
  std::vector<Vertex> points = box(6000, 0.002);
  for (std::size_t i = 0; i < points.size(); i += 3) points[i].n[0] *= -1.0;
  const CloudTable table = tableOf(directory, points);
  EXPECT_EQ(draw(table, 35.0, 25.0, 1).rgb, draw(table, 35.0, 25.0, 3).rgb);
}

// A sheet seen by sensors above it: right from behind as well, and what faces away is red.
TEST(Pictures, KnownSensorsTellTheTrueSide) {
  const ScratchDirectory directory;
  const auto sheet = [&](double sign) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::ostringstream text;
    text << "x y z normal_x normal_y normal_z vp_x vp_y vp_z\n";
    for (int i = 0; i < 2000; ++i) {
      text << unit(random) << ' ' << unit(random) << " 0 0 0 " << sign << " 0 0 3\n";
    }
    return program::readCloud(directory.write("sheet.txt", text.str()));
  };
  for (const double elevation : {-70.0, 70.0}) {
    EXPECT_EQ(redPixels(draw(sheet(1.0), 0.0, elevation)), 0U);
    EXPECT_GT(redPixels(draw(sheet(-1.0), 0.0, elevation)), 20000U);
  }
}

bool isBrown(const std::uint8_t* p) {
  return p[0] > p[2] + 12 && !isRed(p) && p[0] < 190;
}

// Of an open sheet either side may be seen, and neither is wrong; a point that contradicts all
// around it is.
TEST(Pictures, AnOpenSheetHasABackButNoWrongSide) {
  const ScratchDirectory directory;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Vertex> sheet;
  for (int i = 0; i < 4000; ++i) sheet.push_back({{unit(random), unit(random), 0}, {0, 0, 1}});
  const auto count = [&](double elevation, bool red) {
    const Picture picture = draw(tableOf(directory, sheet), 0.0, elevation);
    std::size_t found = 0;
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
      found += (red ? isRed(&picture.rgb[i]) : isBrown(&picture.rgb[i])) ? 1U : 0U;
    }
    return found;
  };
  EXPECT_EQ(count(60.0, true) + count(-60.0, true), 0U);
  EXPECT_EQ(count(60.0, false), 0U);
  EXPECT_GT(count(-60.0, false), 30000U);
  sheet[0].n[2] = -1.0;
  EXPECT_GT(count(60.0, true), 4U);  // its share among the discs around
  EXPECT_GT(count(-60.0, true), 4U);
}

TEST(Pictures, AnObjectInsideOutIsRedAllOver) {
  const ScratchDirectory directory;
  std::vector<Vertex> points = box(6000, 0.002);
  for (Vertex& v : points) {
    for (double& n : v.n) n = -n;
  }
  const Picture picture = draw(tableOf(directory, points), 35.0, 25.0);
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    drawn += picture.rgb[i + 1] < 250 ? 1U : 0U;
  }
  EXPECT_GT(redPixels(picture), drawn * 95 / 100);
}

std::vector<program::Side> sidesOf(const std::vector<Vertex>& points, int threads) {
  std::vector<float> rows;
  std::vector<float> normals;
  for (const Vertex& v : points) {
    for (const double p : v.p) rows.push_back(static_cast<float>(p));
    for (const double n : v.n) normals.push_back(static_cast<float>(n));
  }
  PointView view;
  view.data = rows.data();
  view.stride = 3;
  view.size = points.size();
  search::MedianHashIndex index;
  index.build(view, nullptr, {});
  Neighborhoods neighborhoods;
  index.nearestKAll(17, neighborhoods);
  float middle = 0.F;
  const auto radii = program::discRadii(neighborhoods, middle, threads);
  return program::findSides(view, normals, neighborhoods, radii, middle, threads);
}

TEST(Sides, DoNotDependOnThreadsNorOnTheOrderOfRows) {
  std::vector<Vertex> points = box(5000, 0.003);
  for (Vertex& v : points) {
    for (double& n : v.n) n *= v.p[0] > 0.5 ? -1.0 : 1.0;
  }
  const auto expected = sidesOf(points, 1);
  EXPECT_EQ(sidesOf(points, 3), expected);
  std::size_t right = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    right += program::isWrong(expected[i]) == (points[i].p[0] > 0.5) ? 1U : 0U;
  }
  EXPECT_GT(right, points.size() * 99 / 100);
  std::reverse(points.begin(), points.end());
  auto reversed = sidesOf(points, 2);
  std::reverse(reversed.begin(), reversed.end());
  EXPECT_EQ(reversed, expected);
}

TEST(Sides, ATurnedFaceIsWrongWhereNoiseHidesItsPlane) {
  // Points are 0.02 apart, and their heights differ by more.
  std::vector<Vertex> points = box(6000, 0.03);
  std::vector<std::size_t> top;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].n[2] > 0.0) top.push_back(i);
  }
  for (const std::size_t i : top) points[i].n[2] = -1.0;
  const auto sides = sidesOf(points, 2);
  const auto wrong = std::count_if(top.begin(), top.end(),
                                   [&](std::size_t i) { return program::isWrong(sides[i]); });
  EXPECT_GT(static_cast<std::size_t>(wrong), top.size() * 95 / 100);
}

// One that no other agrees with may be all that there is of a face, where most of what lies around
// is beyond an edge; in the middle of a face it is wrong.
TEST(Sides, ALonePointIsWrongInAFaceAndOpenBesideAnEdge) {
  std::vector<Vertex> points = box(6000, 0.0);
  points.push_back({{0.5, 0.35, 0.4}, {0.0, 0.0, -1.0}});
  points.push_back({{0.0005, 0.0005, 0.4}, {0.0, 0.0, -1.0}});  // in a corner of three faces
  const auto sides = sidesOf(points, 2);
  EXPECT_TRUE(program::isWrong(sides[points.size() - 2]));
  EXPECT_FALSE(program::isWrong(sides[points.size() - 1]));
}

TEST(Pictures, HeightsAreDarkBelowAndLightAboveAndTheLegendSaysSo) {
  const ScratchDirectory directory;
  const CloudTable table = tableOf(directory, box(6000, 0.0));
  Picture picture = draw(table, 0.0, 0.0, 1, program::Coloring::Height);
  const auto brightness = [&](std::size_t y) {
    const std::uint8_t* p = &picture.rgb[3 * (300 * y + 150)];
    return p[0] + p[1] + p[2];
  };
  EXPECT_GT(brightness(80), brightness(220) + 60);  // the cloud is at rows 71 to 229
  const program::Legend legend = program::Palette(table, program::Coloring::Height, {}).legend();
  EXPECT_EQ(legend.low, "0");
  EXPECT_EQ(legend.high, "0.4");
  const Picture before = picture;
  program::drawLegend(legend, picture);
  EXPECT_NE(picture.rgb, before.rgb);
  Picture small(2, 1);  // no room at all
  program::drawLegend(legend, small);
}

TEST(BlueNoise, EveryBeginningIsSpreadEvenlyWhateverTheOrderOfRows) {
  std::mt19937 random(21);
  std::uniform_real_distribution<float> unit;
  std::vector<float> square;
  for (int i = 0; i < 4000; ++i) {
    // Dense at one side.
    const float x = unit(random);
    square.insert(square.end(), {x * x, unit(random), 0.F});
  }
  PointView view;
  view.data = square.data();
  view.stride = 3;
  view.size = 4000;
  const auto order = program::blueNoiseOrder(view, 1000);
  ASSERT_EQ(order.size(), 1000U);
  for (const std::size_t count : {60U, 250U, 1000U}) {
    // The closest two are as far apart as a random choice would not have them: for n random places
    // the expected smallest distance is about 0.5 / n, of n spread ones about 0.7 / sqrt (n).
    double closest = 10.0;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const float* p = view[order[i]];
        const float* q = view[order[j]];
        closest = std::min(closest, std::hypot(static_cast<double>(p[0] - q[0]),
                                               static_cast<double>(p[1] - q[1])));
      }
    }
    EXPECT_GT(closest, 0.25 / std::sqrt(static_cast<double>(count))) << count;
  }
  std::vector<float> reversed;
  for (std::size_t i = 4000; i-- > 0;) reversed.insert(reversed.end(), view[i], view[i] + 3);
  PointView back = view;
  back.data = reversed.data();
  const auto again = program::blueNoiseOrder(back, 1000);
  for (std::size_t i = 0; i < 1000; ++i) ASSERT_EQ(again[i], 3999 - order[i]) << i;
}

TEST(BlueNoise, TakesWhatThereIs) {
  const std::vector<float> points{0.F, 0.F, 0.F, NAN, 0.F, 0.F, 0.F, 0.F, 0.F, 1e30F, 0.F, 0.F};
  PointView view;
  view.data = points.data();
  view.stride = 3;
  view.size = 4;
  EXPECT_EQ(program::blueNoiseOrder(view, 10).size(), 3U);
  EXPECT_EQ(program::blueNoiseOrder(view, 2).size(), 2U);
  view.size = 0;
  EXPECT_TRUE(program::blueNoiseOrder(view, 2).empty());
}

}  // namespace
}  // namespace segorient::test
