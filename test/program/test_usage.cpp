// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Words on the command line, help, exit statuses, and what is left when something goes wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "run_program.h"

namespace segorient::test {
namespace {

const std::vector<std::string> kCommands{"orient",      "sensors", "normals", "segment",
                                         "triangulate", "knn",     "check",   "compare",
                                         "evaluate",    "render",  "view",    "tiles"};

TEST(Usage, HelpOfTheProgramAndOfEveryCommand) {
  const Outcome help = runProgram({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const std::string& command : kCommands) {
    EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << command;
    const Outcome own = runProgram({command, "--help"});
    EXPECT_EQ(own.status, 0) << command;
    EXPECT_NE(own.out.find("Usage: segorient " + command), std::string::npos) << command;
    EXPECT_NE(own.out.find("Example:\n  segorient " + command), std::string::npos) << command;
    EXPECT_TRUE(own.err.empty()) << command;
    EXPECT_EQ(runProgram({"help", command}).out, own.out) << command;
  }
  // All that the program has are in the list above.
  const std::size_t from = help.out.find("Commands:\n");
  const std::size_t end = help.out.find("\n\n", from);
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(static_cast<std::size_t>(
                std::count(help.out.begin() + static_cast<std::ptrdiff_t>(from),
                           help.out.begin() + static_cast<std::ptrdiff_t>(end), '\n')),
            kCommands.size());
  EXPECT_EQ(runProgram({"--version"}).out, "segorient 1.0.0\n");
  const std::string orient = runProgram({"orient", "--help"}).out;
  EXPECT_EQ(runProgram({"help", "orient"}).out, orient);
  EXPECT_EQ(runProgram({"--help", "orient"}).out, orient);
  EXPECT_EQ(runProgram({"help", "polish"}).status, 2);
  for (const std::string again : {"help", "--help", "-h"}) {
    EXPECT_EQ(runProgram({"help", again}).out, help.out);
    EXPECT_EQ(runProgram({again, again}).out, help.out);
  }
  EXPECT_NE(help.out.find(".html"), std::string::npos);
  EXPECT_NE(runProgram({"segment", "--help"}).out.find("--method arg"), std::string::npos);
  EXPECT_NE(runProgram({"view", "--help"}).out.find("height"), std::string::npos);
  // What a command makes no use of is not in its help.
  EXPECT_NE(orient.find("--verbose"), std::string::npos);
  EXPECT_EQ(runProgram({"segment", "--help"}).out.find("--verbose"), std::string::npos);
  EXPECT_EQ(runProgram({"view", "--help"}).out.find("--threads"), std::string::npos);
}

// A report that can't be written: no output either, and what was there stays.
TEST(Usage, OutputAndReportAreBothOrNone) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> commands{
      {{"orient", fandisk()}, "out.pcd"},
      {{"orient", fandisk(), "--method", "hoppe"}, "out.ply"},
      {{"segment", fandisk()}, "out.pcd"},
      {{"check", fandisk()}, "out.pcd"}};
  for (const auto& [command, name] : commands) {
    for (const bool existed : {false, true}) {
      const ScratchDirectory directory;
      const std::string out = directory.file(name);
      if (existed) directory.write(name, "as it was");
      for (const std::string& report : {directory.file("none/report.json"), directory.file("")}) {
        std::vector<std::string> words = command;
        words.insert(words.begin() + 2, out);
        words.insert(words.end(), {"-q", "--report", report});
        SCOPED_TRACE(command[0] + " --report " + report);
        const Outcome run = runProgram(words);
        EXPECT_EQ(run.status, 1);
        EXPECT_TRUE(isOneLine(run.err)) << run.err;
        EXPECT_NE(run.err.find(report), std::string::npos) << run.err;
        EXPECT_EQ(directory.entries(), existed ? 1U : 0U);
        if (existed) {
          EXPECT_EQ(readFile(out), "as it was");
        }
      }
    }
  }
}

TEST(Usage, WrongUsageIsStatus2AndOneLine) {
  const ScratchDirectory directory;
  const std::string out = directory.file("out.pcd");
  EXPECT_EQ(runProgram({}).status, 2);
  const std::vector<std::vector<std::string>> wrong{
      {"polish"},
      {"orient"},
      {"orient", fandisk()},
      {"orient", fandisk(), directory.file("out.laz")},
      {"orient", fandisk(), directory.file("out")},
      {"orient", fandisk(), out, "--metho", "auto"},
      {"orient", fandisk(), out, "--method", "best"},
      {"orient", fandisk(), out, "--normals", "fft"},
      {"orient", fandisk(), out, "-k", "0"},
      {"orient", fandisk(), out, "-k", "many"},
      {"orient", fandisk(), out, "--alpha", "-5"},
      {"orient", fandisk(), out, "--beta", "nan"},
      {"orient", fandisk(), out, "--threads", "-1"},
      {"orient", fandisk(), out, "--threads", "99999999999999999999"},
      {"orient", fandisk(), out, "--report"},
      {"normals", fandisk(), directory.file("out.vtk")},
      {"render", fandisk(), directory.file("out.jpg")},
      {"render", fandisk(), directory.file("out.png"), "--width", "0"},
      {"render", fandisk(), directory.file("out.html"), "--points", "0"},
      {"render", fandisk(), directory.file("out.html"), "--points", "-1"},
      {"render", fandisk(), directory.file("out.png"), "--azimuth", "nan"},
      {"compare", fandisk(), "--picture", directory.file("out.png"), "--elevation", "inf"},
      {"render", fandisk(), directory.file("out.png"), "--color", "taste"},
      {"evaluate", fandisk()}};
  for (const auto& words : wrong) {
    std::string line;
    for (const std::string& word : words) line += word + " ";
    SCOPED_TRACE(line);
    const Outcome run = runProgram(words);
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_TRUE(run.out.empty());
  }
  EXPECT_EQ(directory.entries(), 0U);
}

// Whatever way its name is written.
TEST(Usage, AReportIsNoOtherFileOfItsCommand) {
  const ScratchDirectory directory;
  const std::string in = directory.write("in.xyz", "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n");
  const std::string before = readFile(in);
  const std::string folder = directory.file("");
  std::filesystem::create_symlink(in, directory.file("link.xyz"));
  const std::size_t entries = directory.entries();
  const std::vector<std::pair<std::vector<std::string>, std::string>> commands{
      {{"orient", in, directory.file("out.ply")}, "./out.ply"},
      {{"orient", in, directory.file("out.ply")}, "./in.xyz"},
      {{"orient", folder, directory.file("out.ply"), "--memory", "2G"}, "in.xyz"},
      {{"orient", in, folder, "--memory", "2G"}, "in.ply"},
      {{"segment", in, directory.file("out.ply")}, "./out.ply"},
      {{"segment", in, directory.file("out.ply")}, "link.xyz"},
      {{"check", in, directory.file("out.ply")}, "./out.ply"},
      {{"check", in}, "./in.xyz"},
      {{"check", in, "--picture", directory.file("a.png")}, "./a.png"},
      {{"evaluate", in, in}, "./in.xyz"}};
  for (const auto& [command, report] : commands) {
    SCOPED_TRACE(command[0] + " --report " + report);
    std::vector<std::string> words = command;
    words.insert(words.end(), {"--report", directory.file(report)});
    const Outcome run = runProgram(words);
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_EQ(readFile(in), before);
    EXPECT_EQ(directory.entries(), entries);
  }
  // Relative names of what is not there yet.
  EXPECT_EQ(runProgram({"orient", in, "no_such.ply", "--report", "./no_such.ply"}).status, 2);
}

TEST(Usage, OutputThatCannotBeWrittenIsStatus1) {
  const ScratchDirectory directory;
  std::filesystem::create_directory(directory.file("taken.pcd"));
  for (const std::string out : {"missing/out.pcd", "taken.pcd"}) {
    const Outcome run = runProgram({"orient", fandisk(), directory.file(out)});
    EXPECT_EQ(run.status, 1) << out;
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_NE(run.err.find(out), std::string::npos) << run.err;
  }
  const Outcome report = runProgram({"orient", fandisk(), directory.file("out.pcd"), "--report",
                                     directory.file("missing/report.json")});
  EXPECT_EQ(report.status, 1);
  EXPECT_FALSE(std::filesystem::exists(directory.file("out.pcd")));
}

TEST(Usage, AFolderIsForTiles) {
  const ScratchDirectory directory;
  const Outcome run =
      runProgram({"orient", SEGORIENT_TEST_DATA, directory.file("out.ply"), "--quiet"});
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(isOneLine(run.err)) << run.err;
  EXPECT_NE(run.err.find("--memory"), std::string::npos) << run.err;
}

// Before hours of work, not after them, and no folder is made for what can't be.
TEST(Usage, OutputOfTilesThatCannotBeWrittenIsStatus1AtOnce) {
  const ScratchDirectory directory;
  std::filesystem::create_directories(directory.file("folder/fandisk_16475.pcd"));
  const std::vector<std::pair<std::string, std::string>> outputs{
      {"missing/out.pcd", "report.json"},
      {"folder", "report.json"},
      {"out.pcd", "missing/report.json"}};
  for (const auto& [out, report] : outputs) {
    const Outcome run = runProgram({"orient", fandisk(), directory.file(out), "--memory", "2G",
                                    "--report", directory.file(report)});
    EXPECT_EQ(run.status, 1) << out;
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_TRUE(run.out.empty()) << run.out;
    EXPECT_EQ(directory.entries(), 1U) << out;
  }
}

TEST(Usage, AFailedRunLeavesThePreviousOutput) {
  const ScratchDirectory directory;
  const std::string out = directory.write("out.pcd", "precious");
  const std::string bad = directory.write("bad.pcd", "FIELDS x y z\nSIZE 4 4 4\n");
  EXPECT_EQ(runProgram({"orient", bad, out}).status, 1);
  EXPECT_EQ(readFile(out), "precious");
  EXPECT_EQ(directory.entries(), 2U);
}

TEST(Usage, InputAndOutputMayBeTheSameFile) {
  const ScratchDirectory directory;
  const std::string both = directory.write("both.pcd", readFile(fandisk()));
  ASSERT_EQ(runProgram({"orient", both, both, "--quiet"}).status, 0);
  const Outcome run = runProgram({"evaluate", fandisk(), both});
  EXPECT_EQ(run.status, 0) << run.err;
}

// What draws is loaded when it is asked for: all else works without it.
TEST(Usage, WithoutTheModuleForPicturesOnlyPicturesFail) {
  const ScratchDirectory directory;
  const std::string alone = directory.file("segorient");
  std::filesystem::copy_file(SEGORIENT_PROGRAM, alone);
  const std::string out = directory.file("out.pcd");
  EXPECT_EQ(runProgram({"normals", fandisk(), out, "--quiet"}, alone).status, 0);
  EXPECT_EQ(runProgram({"render", out, directory.file("page.html")}, alone).status, 0);
  const Outcome run = runProgram({"render", out, directory.file("out.png")}, alone);
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(isOneLine(run.err)) << run.err;
  EXPECT_NE(run.err.find("segorient_vtk"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(directory.file("out.png")));
  EXPECT_EQ(runProgram({"render", out, directory.file("out.png")}).status, 0);
}

}  // namespace
}  // namespace segorient::test
