// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The same bytes from run to run and for any number of threads, and the same orientation of each
// point whatever their order.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <sstream>

#include "io/readers.h"
#include "run_program.h"

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

}  // namespace
}  // namespace segorient::test
