// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The same bytes from run to run and for any number of threads, and the same orientation of each
// point whatever their order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>
#include <sstream>

#include "io/readers.h"
#include "run_program.h"
#include "sensor_scans.h"

namespace segorient::test {
namespace {

struct Run {
  const char* name;
  std::vector<std::string> words;  ///< command and options
  const char* output;
};

class Determinism : public testing::TestWithParam<Run> {};

TEST_P(Determinism, SameBytesForAnyThreadsAndAnyRun) {
  const ScratchDirectory directory;
  const std::string out = directory.file(GetParam().output);
  std::string first;
  for (const std::string threads : {"1", "1", "2", "7", "65537"}) {
    std::vector<std::string> words = GetParam().words;
    words.insert(words.begin() + 1, {fandisk(), out});
    words.insert(words.end(), {"--threads", threads});
    const Outcome run = runProgram(words);
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string bytes = readFile(out);
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
  EXPECT_FALSE(first.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Commands, Determinism,
    testing::Values(
        Run{"orient", {"orient"}, "out.pcd"},
        Run{"propagation", {"orient", "--method", "propagation"}, "out.ply"},
        Run{"boundary", {"orient", "--method", "boundary"}, "out.pcd"},
        Run{"combined", {"orient", "--method", "combined"}, "out.pcd"},
        Run{"extremal", {"orient", "--method", "extremal"}, "out.pcd"},
        Run{"plane", {"normals"}, "out.pcd"},
        Run{"ldt_recomputed", {"normals", "--normals", "ldt", "--recompute", "2"}, "out.pcd"},
        Run{"awas3", {"normals", "--normals", "awas3"}, "out.pcd"},
        Run{"segment", {"segment"}, "out.pcd"}, Run{"triangulate", {"triangulate"}, "out.vtk"},
        Run{"knn", {"knn"}, "out.csv"}, Run{"render", {"render"}, "out.png"},
        Run{"page", {"render", "--points", "5000"}, "out.html"}),
    [](const testing::TestParamInfo<Run>& run) { return std::string(run.param.name); });

// The shipped cloud with its rows in another order, as text.
std::string shuffledText(const program::CloudTable& cloud, const std::vector<std::size_t>& rows) {
  std::ostringstream text;
  text.precision(9);
  for (const std::size_t row : rows) {
    const auto p = cloud.position(row);
    text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  }
  return text.str();
}

TEST(DeterminismOfOrder, ShuffledPointsHaveTheSameNormals) {
  const ScratchDirectory directory;
  const program::CloudTable cloud = program::readCloud(fandisk());
  std::vector<std::size_t> rows(cloud.size);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::shuffle(rows.begin(), rows.end(), std::mt19937(5));
  const std::string shuffled = directory.write("in.xyz", shuffledText(cloud, rows));
  for (const std::string method : {"auto", "propagation", "boundary", "combined", "extremal"}) {
    SCOPED_TRACE(method);
    const std::string a = directory.file("a.pcd");
    const std::string b = directory.file("b.pcd");
    ASSERT_EQ(runProgram({"orient", fandisk(), a, "--method", method, "-q"}).status, 0);
    ASSERT_EQ(runProgram({"orient", shuffled, b, "--method", method, "-q"}).status, 0);
    const program::CloudTable first = program::readCloud(a);
    const program::CloudTable second = program::readCloud(b);
    ASSERT_EQ(second.size, first.size);
    std::size_t different = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto n = first.triple(first.normals(), rows[i]);
      const auto m = second.triple(second.normals(), i);
      if (!(n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0.999)) ++different;
    }
    EXPECT_EQ(different, 0U);
  }
}

std::string noisyFandisk(double deviation) {
  const program::CloudTable cloud = program::readCloud(fandisk());
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, deviation);
  std::ostringstream text;
  text.precision(9);
  for (std::size_t row = 0; row < cloud.size; ++row) {
    for (const double v : cloud.position(row)) text << v + noise(random) << ' ';
    text << '\n';
  }
  return text.str();
}

// As two scanners see it.
std::string scannedRoom() {
  std::ostringstream text;
  text.precision(9);
  for (const Vector& station : {Vector{1.1, 1.0, 1.2}, Vector{4.0, 2.9, 1.5}}) {
    Scan scan = scanFrom(station, 2.0);
    const std::vector<float>& rows = scan.rows();
    for (std::size_t i = 0; i < rows.size(); ++i) text << rows[i] << (i % 3 == 2 ? '\n' : ' ');
  }
  return text.str();
}

// Fields of dipoles decide in noise, and densities tell where sensors were.
TEST(DeterminismOfMachines, SameBytesForAnyInstructionSet) {
  constexpr double kSpacing = 0.06;
  const ScratchDirectory directory;
  const std::string noisy = directory.write("noisy.xyz", noisyFandisk(0.5 * kSpacing));
  const std::string room = directory.write("room.xyz", scannedRoom());
  const std::string out = directory.file("out.ply");
  const std::string json = directory.file("sensors.json");
  std::string bytes;
  std::string report;
  for (const char* set : {"scalar", "sse2", "avx2", "avx512"}) {
    SCOPED_TRACE(set);
    setenv("SEGORIENT_SIMD", set, 1);
    const Outcome oriented = runProgram({"orient", noisy, out, "-q"});
    const Outcome sensors = runProgram({"sensors", room, json});
    unsetenv("SEGORIENT_SIMD");
    ASSERT_EQ(oriented.status, 0) << oriented.err;
    ASSERT_EQ(sensors.status, 0) << sensors.err;
    if (bytes.empty()) {
      bytes = readFile(out);
      report = readFile(json);
    }
    EXPECT_TRUE(readFile(out) == bytes);
    EXPECT_EQ(readFile(json), report);
    EXPECT_NE(report.find("several places explain"), std::string::npos) << report;
  }
}

}  // namespace
}  // namespace segorient::test
