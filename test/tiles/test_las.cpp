// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// LAS tile by tile: what comes out is, but for the normals' last digits, what comes out in memory.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "las_sample.h"
#include "run_program.h"
#include "tile_clouds.h"

namespace segorient::test {
namespace {

namespace fs = std::filesystem;

// A hollow sphere in a point format, at map coordinates.
LasSample sphere(int format, std::size_t n) {
  LasSample sample = lasSample(format, static_cast<int>(n));
  sample.records = lasRecord("LASF_Projection", 2112, "COORDINATES OF SOMEWHERE");
  sample.record_count = 1;
  const std::vector<double> xyz = hollowSphere(n, 0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      putAt(sample.points[i], 4 * a, static_cast<std::int32_t>(std::lround(1e5 * xyz[3 * i + a])));
    }
  }
  return sample;
}

void expectRuns(const std::string& in, const std::string& out, bool by_tiles) {
  std::vector<std::string> words{"orient", in, out, "-q"};
  if (by_tiles) words.insert(words.end(), {"--memory", "1G", "--tile-points", "1500"});
  const Outcome run = runProgram(words);
  ASSERT_EQ(run.status, 0) << run.err;
}

std::uint32_t number32(const std::string& bytes, std::size_t at) {
  std::uint32_t v = 0;
  std::memcpy(&v, &bytes[at], sizeof(v));
  return v;
}

TEST(TilesOfLas, GiveTheFileThatMemoryGives) {
  const ScratchDirectory scratch;
  constexpr std::size_t kPoints = 4000;
  for (const int format : {0, 3, 7}) {
    SCOPED_TRACE(format);
    const std::string in = scratch.write("in.las", sphere(format, kPoints).bytes());
    const std::string whole = scratch.file("whole.las");
    const std::string tiled = scratch.file("tiled.las");
    expectRuns(in, whole, false);
    expectRuns(in, tiled, true);
    const std::string a = readFile(whole);
    const std::string b = readFile(tiled);
    ASSERT_EQ(a.size(), b.size());
    const std::size_t begin = number32(a, 96);
    EXPECT_TRUE(a.compare(0, begin, b, 0, begin) == 0) << "header and records";
    std::uint16_t row = 0;
    std::memcpy(&row, &a[105], sizeof(row));
    ASSERT_EQ(a.size(), begin + kPoints * row);
    const std::size_t standard = lasRecordBytes(format);
    for (std::size_t i = 0; i < kPoints; ++i) {
      ASSERT_TRUE(a.compare(begin + i * row, standard, b, begin + i * row, standard) == 0) << i;
    }
    EXPECT_EQ(sameSides(whole, tiled), kPoints);
  }
}

// Files of several grids get one that holds the points of all, as in memory.
TEST(TilesOfLas, SeveralGridsAreNotRoundedToOne) {
  const ScratchDirectory scratch;
  const LasSample all = sphere(1, 3000);
  LasSample coarse = all;
  coarse.points.assign(all.points.begin(), all.points.begin() + 1500);
  coarse.scale *= 100.0;
  LasSample fine = all;
  fine.points.assign(all.points.begin() + 1500, all.points.end());
  const std::string first = scratch.write("a.las", coarse.bytes());
  const std::string second = scratch.write("b.las", fine.bytes());
  const std::string out = scratch.file("out.las");
  const Outcome run =
      runProgram({"orient", first, second, out, "-q", "--memory", "1G", "--tile-points", "1500"});
  ASSERT_EQ(run.status, 0) << run.err;
  const program::CloudTable joint = program::readCloud(out);
  const program::CloudTable one = program::readCloud(second);
  ASSERT_EQ(joint.size, 3000U);
  for (std::size_t i = 0; i < one.size; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_NEAR(joint.position(1500 + i)[a], one.position(i)[a], 0.01 * all.scale) << i;
    }
  }
}

TEST(TilesOfLas, EachFileOfAFolderStaysOne) {
  const ScratchDirectory scratch;
  fs::create_directory(scratch.file("in"));
  fs::create_directory(scratch.file("out"));
  constexpr std::size_t kPoints = 3000;
  LasSample all = sphere(1, kPoints);
  LasSample part = all;
  part.points.assign(all.points.begin(), all.points.begin() + 1000);
  scratch.write("in/a.las", part.bytes());
  part.points.assign(all.points.begin() + 1000, all.points.end());
  scratch.write("in/b.las", part.bytes());
  expectRuns(scratch.file("in"), scratch.file("out"), true);
  expectRuns(scratch.file("in"), scratch.file("one.ply"), true);
  const program::CloudTable one = program::readCloud(scratch.file("one.ply"));
  ASSERT_EQ(one.size, kPoints);
  std::size_t row = 0;
  for (const char* name : {"out/a.las", "out/b.las"}) {
    const program::CloudTable table = program::readCloud(scratch.file(name));
    for (std::size_t i = 0; i < table.size; ++i, ++row) {
      ASSERT_EQ(table.position(i), one.position(row));
      ASSERT_EQ(table.triple(table.normals(), i), one.triple(one.normals(), row)) << name << i;
    }
  }
  EXPECT_EQ(row, kPoints);
}

}  // namespace
}  // namespace segorient::test
