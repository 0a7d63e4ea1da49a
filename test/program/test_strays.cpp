// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Stray points in a cloud of map coordinates must not cost the others their precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <limits>
#include <random>

#include "common/bulk_bounds.h"
#include "io/cloud_table.h"
#include "io/cloud_writer.h"
#include "io/readers.h"
#include "las_sample.h"
#include "scratch_directory.h"

namespace segorient::test {
namespace {

using program::CloudTable;
using program::LocalPoints;
using Point = std::array<double, 3>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Point kMap{500123.25, 5412345.5, 312.125};

std::vector<Point> mapCloud(std::size_t n) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-10.0, 10.0);
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = u(random);
    const double y = u(random);
    points.push_back({kMap[0] + x, kMap[1] + y, kMap[2] + 30.0 * std::sin(0.3 * x)});
  }
  return points;
}

void addStrays(std::vector<Point>& points, std::size_t count, double at) {
  for (std::size_t i = 0; i < count; ++i) {
    points.insert(points.begin() + static_cast<std::ptrdiff_t>(i * points.size() / count),
                  {at, at, at});
  }
}

CloudTable tableOf(const std::vector<Point>& points) {
  CloudTable table;
  for (const char* name : {"x", "y", "z"}) table.addField(name, 'F', 8);
  table.size = table.width = points.size();
  table.rows.resize(table.size * table.row_bytes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(table.rows.data() + i * table.row_bytes, points[i].data(), table.row_bytes);
  }
  return table;
}

Bounds boundsOf(const std::vector<Point>& points) {
  return bulkBounds(points.size(), [&](std::size_t i) { return points[i]; });
}

TEST(Strays, DoNotMoveTheFrame) {
  const std::vector<Point> clean = mapCloud(2000);
  const Bounds expected = boundsOf(clean);
  ASSERT_TRUE(expected.isFar());
  for (const std::size_t count : {1U, 10U, 100U}) {
    // The last: all that there is lies far from the origin, the strays as well.
    for (const double at : {0.0, 1e30, -1e300, kNaN, 2e7, 2e6}) {
      std::vector<Point> points = clean;
      addStrays(points, count, at);
      const CloudTable table = tableOf(points);
      const LocalPoints local(table);
      SCOPED_TRACE(std::to_string(count) + " at " + std::to_string(at));
      EXPECT_EQ(local.extent(), expected.extent());
      EXPECT_EQ(local.origin(), expected.middle());
      std::size_t good = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i][0] == at || std::isnan(points[i][0])) continue;
        ++good;
        for (std::size_t a = 0; a < 3; ++a) {
          ASSERT_NEAR(static_cast<double>(local.view()[i][a]), points[i][a] - local.origin()[a],
                      1e-6);
        }
      }
      EXPECT_EQ(good, clean.size());
      const bool beyond_floats = std::isnan(at) || std::abs(at) > 1e20;
      EXPECT_EQ(local.finite(), clean.size() + (beyond_floats ? 0 : count));
    }
  }
}

// What lies wide apart without being astray keeps the frame that it had.
TEST(Strays, AreNotWhatThinsOut) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Point> scan;
  for (int i = 0; i < 5000; ++i) {
    const double range = 2.0 / (0.01 + u(random));
    const double angle = 6.28 * u(random);
    scan.push_back({range * std::cos(angle), range * std::sin(angle), 0.01 * range});
  }
  EXPECT_FALSE(boundsOf(scan).isFar());
  const CloudTable scan_table = tableOf(scan);
  EXPECT_EQ(LocalPoints(scan_table).finite(), scan.size());
  EXPECT_EQ(LocalPoints(scan_table).origin(), (Point{0.0, 0.0, 0.0}));
  // More than half in one place, as of a camera that saw nothing: no point is a stray.
  std::vector<Point> holes(3000, Point{0.0, 0.0, 0.0});
  for (const Point& p : scan) holes.push_back(p);
  for (int i = 0; i < 4000; ++i) holes.push_back({0.0, 0.0, 0.0});
  const CloudTable table = tableOf(holes);
  const LocalPoints local(table);
  EXPECT_EQ(local.finite(), holes.size());
  EXPECT_EQ(local.origin(), (Point{0.0, 0.0, 0.0}));
}

TEST(Strays, OfAllSortsOfCloudsDoNotHarm) {
  EXPECT_EQ(boundsOf({}).points, 0U);
  EXPECT_EQ(boundsOf({{kNaN, 0.0, 0.0}}).points, 0U);
  EXPECT_EQ(boundsOf({{1.0, 2.0, 3.0}}).extent(), 0.0);
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(boundsOf({{-most, 0.0, 0.0}, {most, 0.0, 0.0}, {0.0, 0.0, 0.0}}).points, 3U);
}

// Every reader that chooses the precision by itself.
TEST(Strays, LeaveTextItsDigits) {
  const ScratchDirectory directory;
  for (const double at : {0.5, 1e30}) {
    std::vector<Point> points = mapCloud(500);
    addStrays(points, 10, at);
    for (const std::string name : {"cloud.xyz", "cloud.pts", "cloud.obj", "cloud.ptx"}) {
      SCOPED_TRACE(name);
      const std::string path = directory.file(name);
      {
        std::ofstream file(path);
        file << std::setprecision(17);
        if (name == "cloud.pts") file << points.size() << "\n";
        if (name == "cloud.ptx") {
          file << points.size() << "\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
               << "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
        }
        for (const Point& p : points) {
          if (name == "cloud.obj") file << "v ";
          file << p[0] << " " << p[1] << " " << p[2] << "\n";
        }
      }
      const CloudTable table = program::readCloud(path);
      ASSERT_EQ(table.size, points.size());
      for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(table.position(i), points[i]);
    }
  }
}

// Of a stray alone, floats are enough for a cloud near the origin.
TEST(Strays, DoNotMakeACloudFar) {
  const ScratchDirectory directory;
  std::string rows;
  for (int i = 0; i < 100; ++i) rows += std::to_string(i) + " " + std::to_string(i * i) + " 1\n";
  for (const std::string name : {"cloud.xyz", "cloud.pts"}) {
    const CloudTable table = program::readCloud(directory.write(name, rows + "1e9 1e9 1e9\n"));
    EXPECT_EQ(table.find("x")->size, 4U) << name;
  }
}

// LAS has whole numbers: what they stand for comes back to the last bit.
TEST(Strays, LeaveLasItsNumbers) {
  const ScratchDirectory directory;
  LasSample sample = lasSample(0, 300);
  for (const std::size_t count : {1U, 10U, 100U}) {
    LasSample spoilt = sample;
    for (std::size_t i = 0; i < count; ++i) {
      std::string point = sample.points[0];
      putAt(point, 0, std::int32_t{-500000000});  // at x = 0
      putAt(point, 4, static_cast<std::int32_t>(-2100000000));
      spoilt.points.insert(spoilt.points.begin() + static_cast<std::ptrdiff_t>(2 * i), point);
    }
    const CloudTable clean = program::readCloud(directory.write("clean.las", sample.bytes()));
    const CloudTable table = program::readCloud(directory.write("spoilt.las", spoilt.bytes()));
    const LocalPoints expected(clean);
    const LocalPoints local(table);
    EXPECT_EQ(local.origin(), expected.origin());
    EXPECT_EQ(local.extent(), expected.extent());
    {
      program::OutputFile file(directory.file("again.las"));
      writeLas(program::OutputCloud(table), file);
      file.commit();
    }
    const CloudTable again = program::readCloud(directory.file("again.las"));
    ASSERT_EQ(again.size, table.size);
    for (std::size_t i = 0; i < table.size; ++i) EXPECT_EQ(again.position(i), table.position(i));
  }
}

// The steps of LAS are those that the cloud has without them; they can't be written.
TEST(Strays, BeyondFloatsAreNotInLas) {
  const ScratchDirectory directory;
  const std::vector<Point> clean = mapCloud(500);
  std::vector<Point> points = clean;
  addStrays(points, 10, 1e30);
  const CloudTable table = tableOf(points);
  {
    program::OutputFile file(directory.file("out.las"));
    writeLas(program::OutputCloud(table), file);
    file.commit();
  }
  const CloudTable again = program::readCloud(directory.file("out.las"));
  ASSERT_EQ(again.size, clean.size());
  for (std::size_t i = 0; i < clean.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(again.position(i)[a], clean[i][a], 1e-6);
  }
}

}  // namespace
}  // namespace segorient::test
