// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What the program says of time and memory, and what it does where memory is short.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "run_program.h"
#include "sanitized.h"

namespace segorient::test {
namespace {

using boost::property_tree::ptree;

std::set<std::string> keysOf(const ptree& object) {
  std::set<std::string> out;
  for (const auto& [key, value] : object) out.insert(key);
  return out;
}

// Time and memory of every stage; the most of all is the process's.
TEST(Report, HasTimeAndPeakMemoryOfEveryStage) {
  const ScratchDirectory directory;
  const std::string path = directory.file("report.json");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"orient"},
        {"orient", "--method", "combined", "--recompute", "1"},
        {"segment", "--recompute", "1"}}) {
    SCOPED_TRACE(words[0] + (words.size() > 1 ? " " + words[1] : ""));
    std::vector<std::string> all{words[0], fandisk(), directory.file("out.pcd"), "--report", path};
    all.insert(all.end(), words.begin() + 1, words.end());
    ASSERT_EQ(runProgram(all).status, 0);
    ptree report;
    boost::property_tree::read_json(path, report);
    std::set<std::string> timed = keysOf(report.get_child("seconds"));
    timed.erase("total");
    timed.insert({"reading", "output", "writing"});
    EXPECT_GE(timed.size(), 6U);
    EXPECT_EQ(keysOf(report.get_child("peak_memory_bytes_by_stage")), timed);
    std::size_t most = 0;
    for (const auto& [stage, bytes] : report.get_child("peak_memory_bytes_by_stage")) {
      // More than the input alone, less than what is plainly too much.
      EXPECT_GT(bytes.get_value<std::size_t>(), 16475U * 12U) << stage;
      EXPECT_LT(bytes.get_value<std::size_t>(), std::size_t{1} << 32U) << stage;
      most = std::max(most, bytes.get_value<std::size_t>());
    }
    EXPECT_EQ(report.get<std::size_t>("peak_memory_bytes"), most);
  }
}

// A file of `n` points of a sphere.
std::string ballFile(const ScratchDirectory& directory, std::size_t n) {
  std::string text =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
      std::to_string(n) + "\nHEIGHT 1\nPOINTS " + std::to_string(n) + "\nDATA binary\n";
  std::vector<float> xyz(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i);
    const double z = 1.0 - 2.0 * (t + 0.5) / static_cast<double>(n);
    const double r = std::sqrt(1.0 - z * z);
    xyz[3 * i] = static_cast<float>(r * std::cos(2.399963229728653 * t));
    xyz[3 * i + 1] = static_cast<float>(r * std::sin(2.399963229728653 * t));
    xyz[3 * i + 2] = static_cast<float>(z);
  }
  text.append(reinterpret_cast<const char*>(xyz.data()), xyz.size() * sizeof(float));
  return directory.write("ball.pcd", text);
}

// Runs `orient` with no more than this many bytes of address space.
Outcome orientWithin(std::size_t limit, const std::string& in, const ScratchDirectory& directory) {
  const std::string err = directory.file("err");
  const pid_t child = fork();
  if (child == 0) {
    const rlimit bytes{limit, limit};
    setrlimit(RLIMIT_AS, &bytes);
    if (std::freopen(err.c_str(), "w", stderr) == nullptr) _exit(126);
    execl(SEGORIENT_PROGRAM, SEGORIENT_PROGRAM, "orient", in.c_str(),
          directory.file("out.pcd").c_str(), "-q", "--threads", "1", nullptr);
    _exit(127);
  }
  Outcome run;
  int status = 0;
  waitpid(child, &status, 0);
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.err = readFile(err);
  return run;
}

// From limits at which the program cannot even be loaded up to one at which there is room for all:
// it must never be ended by a signal, and once it can read the file it says what it lacks before it
// starts.
TEST(ShortOfMemory, SaysSoBeforeItStarts) {
#ifdef SEGORIENT_MEMORY_SANITIZED
  GTEST_SKIP() << "the sanitizer itself takes all addresses";
#endif
  const ScratchDirectory directory;
  const std::string in = ballFile(directory, 400'000);
  int refused = 0;
  int status = 1;
  constexpr std::size_t kStep = std::size_t{16} << 20U;
  for (std::size_t limit = 2 * kStep; limit < 200 * kStep && status != 0; limit += kStep) {
    const Outcome run = orientWithin(limit, in, directory);
    status = run.status;
    if (status == 0) break;
    EXPECT_TRUE(status == 1 || status == 127) << limit << ": " << status << " " << run.err;
    EXPECT_FALSE(run.err.empty());
    EXPECT_EQ(readFile(directory.file("out.pcd")), "") << "no output, not even a part";
    const std::string start = "segorient: " + in + ": takes about ";
    const bool says = run.err.compare(0, start.size(), start) == 0;
    if (says) {
      EXPECT_NE(run.err.find(" of memory to work on, and "), std::string::npos);
      EXPECT_TRUE(isOneLine(run.err)) << run.err;
      ++refused;
    } else {
      EXPECT_EQ(refused, 0) << "started with too little: " << run.err;
    }
  }
  EXPECT_EQ(status, 0) << "never enough";
  EXPECT_GE(refused, 3);
}

}  // namespace
}  // namespace segorient::test
