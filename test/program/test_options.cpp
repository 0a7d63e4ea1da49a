// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Options that all commands share, warnings, hints, the report's page, and Ctrl-C.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <boost/property_tree/json_parser.hpp>

#include <signal.h>
#include <unistd.h>
#include <chrono>
#include <cmath>
#include <functional>
#include <regex>
#include <set>
#include <thread>

#include "io/readers.h"
#include "run_program.h"

namespace segorient::test {
namespace {

using program::CloudTable;

TEST(Options, EveryCommandTakesWhatAllShare) {
  const ScratchDirectory directory;
  const std::string in = directory.write("in.xyz", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string out = directory.file("out.ply");
  ASSERT_EQ(runProgram({"orient", in, out}).status, 0);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"orient", in, directory.file("a.pcd")},
        {"normals", in, directory.file("b.pcd")},
        {"segment", in, directory.file("c.pcd")},
        {"triangulate", in, directory.file("d.ply")},
        {"knn", in},
        {"sensors", in},
        {"compare", in},
        {"evaluate", out, out},
        {"render", out, directory.file("e.png")}}) {
    SCOPED_TRACE(command[0]);
    std::vector<std::string> words = command;
    for (const char* word :
         {"-k", "3", "--threads", "1", "--alpha", "20", "--beta", "30", "--gamma", "35", "--delta",
          "30", "--epsilon", "10", "--seed", "7", "--verbose", "--quiet"}) {
      words.emplace_back(word);
    }
    const Outcome run = runProgram(words);
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(run.out, "");
  }
  // Without a screen view gets no further than that.
  unsetenv("DISPLAY");
  EXPECT_EQ(runProgram({"view", out, "-k", "3", "--seed", "1", "--quiet"}).status, 1);
  setenv("DISPLAY", ":98765", 1);
  const Outcome unreached = runProgram({"view", out});
  unsetenv("DISPLAY");
  EXPECT_EQ(unreached.status, 1);
  EXPECT_TRUE(isOneLine(unreached.err)) << unreached.err;
}

TEST(Options, ThoseWithoutEffectAreNamed) {
  const ScratchDirectory directory;
  const std::string out = directory.file("out.pcd");
  for (const std::string name : {"--delta", "--gamma"}) {
    const Outcome run = runProgram({"orient", fandisk(), out, name, "30"});
    EXPECT_EQ(run.status, 0);
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
  }
  EXPECT_NE(runProgram({"orient", fandisk(), out, "--normals", "ldt"}).err, "");
  EXPECT_NE(runProgram({"segment", fandisk(), out, "--delta", "30"}).err, "");
  EXPECT_EQ(runProgram({"segment", fandisk(), out, "--normals", "ldt", "--recompute", "1"}).err,
            "");
  EXPECT_NE(runProgram({"orient", fandisk(), out, "--method", "combined", "--open"}).err, "");
  EXPECT_EQ(runProgram({"orient", fandisk(), out, "--method", "combined", "--normals", "ldt",
                        "--recompute", "1", "--delta", "40"})
                .err,
            "");
}

TEST(Options, ThoseOfStagesThatACommandDoesNotComeToAreNamed) {
  const ScratchDirectory directory;
  const std::string in = directory.write("in.xyz", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string out = directory.file("out.pcd");
  const auto warnsOf = [](std::vector<std::string> words, const std::string& option,
                          const std::string& value) {
    words.push_back(option);
    if (!value.empty()) words.push_back(value);
    const Outcome run = runProgram(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return isOneLine(run.err) && run.err.find(option + " changes nothing") != std::string::npos;
  };
  for (const char* angle : {"--alpha", "--beta", "--epsilon", "--delta", "--gamma"}) {
    EXPECT_TRUE(warnsOf({"normals", in, out}, angle, "25")) << angle;
    EXPECT_TRUE(warnsOf({"knn", in}, angle, "25")) << angle;
    EXPECT_TRUE(warnsOf({"sensors", in}, angle, "25")) << angle;
  }
  EXPECT_TRUE(warnsOf({"normals", in, out}, "--method", "combined"));
  EXPECT_TRUE(warnsOf({"sensors", in}, "-k", "8"));
  EXPECT_TRUE(warnsOf({"segment", in, out}, "--gamma", "25"));
  EXPECT_TRUE(warnsOf({"segment", in, out, "--method", "combined"}, "--faces", ""));
  EXPECT_TRUE(warnsOf({"segment", in, out, "--normals", "ldt"}, "--open", ""));
  EXPECT_TRUE(warnsOf({"orient", in, out}, "--work", directory.file("work")));
  EXPECT_TRUE(warnsOf({"compare", in}, "--azimuth", "25"));
  EXPECT_TRUE(warnsOf({"compare", in}, "--depth", "5"));
  EXPECT_TRUE(warnsOf({"compare", in}, "--truth", in));
  EXPECT_TRUE(warnsOf({"render", in, directory.file("a.html")}, "--width", "300"));
  EXPECT_TRUE(warnsOf({"render", in, directory.file("a.html")}, "--single", ""));
  EXPECT_TRUE(warnsOf({"render", in, directory.file("a.png")}, "--points", "300"));
  EXPECT_FALSE(warnsOf({"render", in, directory.file("a.html")}, "--points", "300"));
  EXPECT_FALSE(warnsOf({"compare", in, "--picture", directory.file("a.png")}, "--azimuth", "25"));
  EXPECT_FALSE(warnsOf({"normals", in, out, "--recompute", "1"}, "--alpha", "25"));
  EXPECT_FALSE(warnsOf({"segment", in, out, "--method", "combined"}, "--gamma", "25"));
  EXPECT_FALSE(warnsOf({"segment", in, out}, "--faces", ""));
}

// The lower half of a sphere far from the origin, with what decides its side.
std::string bowl(const std::string& more_names = "", const std::string& more_values = "") {
  std::string text = "x y z" + more_names + "\n";
  char line[128];
  for (int i = 0; i < 4000; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / 4000.0;
    if (z > 0.0) continue;
    const double r = std::sqrt(1.0 - z * z);
    const double angle = 2.399963229728653 * i;
    std::snprintf(line, sizeof(line), "%.9f %.9f %.9f", 500000.0 + r * std::cos(angle),
                  5400000.0 + r * std::sin(angle), 100.0 + z);
    text += line + more_values + "\n";
  }
  return text;
}

// Share of the bowl's normals that point away from its centre.
double outward(const std::string& path) {
  const CloudTable table = program::readCloud(path);
  std::size_t count = 0;
  for (std::size_t i = 0; i < table.size; ++i) {
    const auto p = table.position(i);
    const auto n = table.triple(table.normals(), i);
    const double dot = n[0] * (p[0] - 500000.0) + n[1] * (p[1] - 5400000.0) + n[2] * (p[2] - 100.0);
    count += dot > 0.0 ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(table.size);
}

TEST(Hints, DecideTheSideOfAnOpenSurface) {
  const ScratchDirectory directory;
  const std::string in = directory.write("in.xyz", bowl());
  const std::string out = directory.file("out.pcd");
  const auto run = [&](const std::vector<std::string>& hints, const std::string& input) {
    std::vector<std::string> words{"orient", input, out};
    words.insert(words.end(), hints.begin(), hints.end());
    const Outcome outcome = runProgram(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outward(out);
  };
  EXPECT_EQ(run({"--open", "--viewpoint=500000,5400000,200"}, in), 0.0);
  EXPECT_EQ(run({"--open", "--viewpoint=500000,5400000,0"}, in), 1.0);
  const std::string below =
      directory.write("below.xyz", bowl(" vp_x vp_y vp_z", " 500000 5400000 0"));
  EXPECT_EQ(run({"--open"}, below), 1.0);
  const std::string above =
      directory.write("above.xyz", bowl(" vp_x vp_y vp_z", " 500000 5400000 200"));
  EXPECT_EQ(run({"--open"}, above), 0.0);
  const Outcome useless = runProgram({"orient", above, out, "--viewpoint=0,0,0"});
  EXPECT_NE(useless.err.find("--viewpoint changes nothing where"), std::string::npos);
  const std::string seed =
      directory.write("seed.xyz", "x y z nx ny nz\n500000 5400000 99 0 0 -1\n");
  EXPECT_EQ(run({"--seeds", seed}, in), 1.0);
  const std::string other =
      directory.write("other.xyz", "x y z nx ny nz\n500000 5400000 99 0 0 1\n");
  EXPECT_EQ(run({"--seeds", other}, in), 0.0);
  // In other coordinates.
  const std::string moved = directory.write("moved.xyz", "x y z nx ny nz\n0 0 99 0 0 -1\n");
  EXPECT_EQ(run({"--seeds", moved}, in), run({}, in));
  const Outcome said = runProgram({"orient", in, out, "--seeds", moved});
  EXPECT_NE(said.out.find("not followed    1 seeds"), std::string::npos) << said.out;
  // What was oriented stays so.
  const std::string kept = directory.file("kept.pcd");
  ASSERT_EQ(runProgram({"orient", in, kept, "--seeds", seed}).status, 0);
  EXPECT_EQ(run({"--keep-orientation"}, kept), 1.0);
  ASSERT_EQ(runProgram({"orient", in, kept, "--seeds", other}).status, 0);
  EXPECT_EQ(run({"--keep-orientation"}, kept), 0.0);
}

TEST(Hints, ThatMakeNoSenseAreRefused) {
  const ScratchDirectory directory;
  const std::string in = directory.write("in.xyz", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string out = directory.file("out.pcd");
  EXPECT_EQ(runProgram({"orient", in, out, "--open", "--closed"}).status, 2);
  EXPECT_EQ(runProgram({"orient", in, out, "--viewpoint=1,2"}).status, 2);
  EXPECT_EQ(runProgram({"orient", in, out, "--viewpoint=1,2,3,4"}).status, 2);
  EXPECT_EQ(runProgram({"orient", in, out, "--viewpoint=nan,0,0"}).status, 2);
  EXPECT_EQ(runProgram({"orient", in, out, "--viewpoint=0,inf,0"}).status, 2);
  for (const std::vector<std::string>& hint :
       {std::vector<std::string>{"--seeds", directory.file("missing.pcd")},
        {"--seeds", in},
        {"--keep-orientation"}}) {
    std::vector<std::string> words{"orient", in, out};
    words.insert(words.end(), hint.begin(), hint.end());
    const Outcome run = runProgram(words);
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
  }
  EXPECT_EQ(directory.entries(), 1U);
}

// Parsers keep one of two values of the same name, and nobody sees the other.
void expectEachOnce(const std::string& path) {
  boost::property_tree::ptree report;
  boost::property_tree::read_json(path, report);
  const std::function<void(const boost::property_tree::ptree&)> check =
      [&](const boost::property_tree::ptree& object) {
        for (const auto& [key, value] : object) {
          EXPECT_TRUE(key.empty() || object.count(key) == 1) << key;
          check(value);
        }
      };
  check(report);
}

std::set<std::string> keys(const std::string& json) {
  std::set<std::string> out;
  const std::regex key("\"([a-z0-9_]+)\":");
  for (std::sregex_iterator it(json.begin(), json.end(), key), end; it != end; ++it) {
    out.insert((*it)[1]);
  }
  return out;
}

TEST(Report, EveryFieldIsExplained) {
  const ScratchDirectory directory;
  const std::string out = directory.file("out.pcd");
  const std::string page = readFile(SEGORIENT_REPORT_PAGE);
  ASSERT_FALSE(page.empty());
  // A surface with one side only has contradictions, and the paper's methods stages of their own.
  std::string moebius;
  char line[96];
  for (int i = 0; i < 200; ++i) {
    for (int j = -10; j <= 10; ++j) {
      const double u = 2.0 * M_PI * i / 200.0;
      const double r = 1.0 + 0.03 * j * std::cos(0.5 * u);
      std::snprintf(line, sizeof(line), "%.6f %.6f %.6f\n", r * std::cos(u), r * std::sin(u),
                    0.03 * j * std::sin(0.5 * u));
      moebius += line;
    }
  }
  const std::string strip = directory.write("strip.xyz", moebius);
  const std::string report = directory.file("report.json");
  std::set<std::string> written;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"orient", strip, out},
        {"orient", fandisk(), out, "--method", "combined", "--recompute", "1"},
        {"segment", fandisk(), out, "--recompute", "1"},
        {"evaluate", fandisk(), out}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--report", report, "--quiet"});
    ASSERT_EQ(runProgram(all).status, 0);
    expectEachOnce(report);
    for (const std::string& key : keys(readFile(report))) written.insert(key);
  }
  EXPECT_GT(written.size(), 35U);
  EXPECT_EQ(written.count("weight"), 1U) << "no contradiction to explain";
  for (const std::string& key : written) {
    EXPECT_NE(page.find("`" + key + "`"), std::string::npos) << key << " is not explained";
  }
}

TEST(Interrupt, LeavesNoHalfFileWhereverItComes) {
  const ScratchDirectory directory;
  std::string text;
  for (int i = 0; i < 60000; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / 60000.0;
    const double r = std::sqrt(1.0 - z * z);
    text += std::to_string(r * std::cos(2.399963229728653 * i)) + " " +
            std::to_string(r * std::sin(2.399963229728653 * i)) + " " + std::to_string(z) + "\n";
  }
  const std::string in = directory.write("in.xyz", text);
  const std::string out = directory.write("out.pcd", "before");
  int interrupted = 0;
  for (const int milliseconds : {20, 60, 120, 250, 400}) {
    const pid_t child = fork();
    if (child == 0) {
      signal(SIGINT, SIG_DFL);  // ignored in what a shell starts in the background
      std::freopen("/dev/null", "w", stdout);
      execl(SEGORIENT_PROGRAM, SEGORIENT_PROGRAM, "orient", in.c_str(), out.c_str(), "--report",
            directory.file("report.json").c_str(), nullptr);
      _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    if (!WIFSIGNALED(status)) continue;  // it was quicker
    EXPECT_EQ(WTERMSIG(status), SIGINT);
    ++interrupted;
    // It may have come after the cloud was there, but never between.
    if (readFile(out) != "before") {
      EXPECT_EQ(program::readCloud(out).size, 60000U);
      continue;
    }
    EXPECT_EQ(directory.entries(), 2U);
  }
  EXPECT_GT(interrupted, 0);
}

}  // namespace
}  // namespace segorient::test
