// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What may go wrong between steps and within them.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>
#include <vector>

#include "run_program.h"
#include "tile_clouds.h"
#include "tiles/input_state.h"

namespace segorient::test {
namespace {

namespace fs = std::filesystem;

// A cloud, a work folder and the steps up to the tiles.
class Faults : public testing::Test {
 protected:
  void SetUp() override {
    in = writeDoubles(scratch.file("in.ply"), hollowSphere(8000, 0.0, 0.0, 0.0));
    out = scratch.file("out.ply");
    folder = scratch.file("work");
  }
  Outcome plan() const {
    return runProgram(
        {"tiles", "plan", folder, in, out, "--memory", "1G", "--tile-points", "3000"});
  }
  Outcome step(const char* name) const { return runProgram({"tiles", name, folder}); }
  void expectRefused(const Outcome& run, const std::string& why) const {
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(isOneLine(run.err)) << run.err;
    EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(out));
  }

  ScratchDirectory scratch;
  std::string in;
  std::string out;
  std::string folder;
};

// Starts the program, and ends it by a signal that it can't see after some milliseconds.
void killAfter(const std::vector<std::string>& words, int milliseconds) {
  std::vector<std::string> all{SEGORIENT_PROGRAM};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> raw;
  for (std::string& word : all) raw.push_back(word.data());
  raw.push_back(nullptr);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    execv(SEGORIENT_PROGRAM, raw.data());
    _exit(127);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
}

TEST_F(Faults, KilledAtAnyMomentTheNextRunGivesTheSameBytes) {
  const std::vector<std::string> words{
      "orient", in, out, "-q", "--work", folder, "--memory", "1G", "--tile-points", "3000"};
  ASSERT_EQ(runProgram(words).status, 0);
  const std::string undisturbed = readFile(out);
  fs::remove(out);
  // Later and later: each run goes on where the one before was killed.
  for (int milliseconds = 20; milliseconds < 800 && !fs::exists(out); milliseconds *= 2) {
    killAfter(words, milliseconds);
    if (fs::exists(out)) {
      EXPECT_TRUE(readFile(out) == undisturbed);
    }
  }
  fs::remove(out);
  // Where files without a name are not to be had, who is killed while the result is written leaves
  // that beside its place, under a name of its own.
  const std::string stray = fs::path(out).filename().string() + ".";
  const fs::directory_iterator beside(fs::path(out).parent_path());
  for (const fs::directory_entry& entry :
       std::vector<fs::directory_entry>(begin(beside), end(beside))) {
    if (entry.path().filename().string().rfind(stray, 0) == 0) fs::remove(entry.path());
  }
  const Outcome last = runProgram(words);
  ASSERT_EQ(last.status, 0) << last.err;
  EXPECT_TRUE(readFile(out) == undisturbed);
  EXPECT_FALSE(fs::exists(folder));
  EXPECT_EQ(scratch.entries(), 2U);
}

TEST_F(Faults, AFileThatWasAlteredOrCutIsFound) {
  ASSERT_EQ(plan().status, 0);
  const std::string points = folder + "/tile-000001.points";
  const std::string whole = readFile(points);
  std::string altered = whole;
  altered[altered.size() / 2] = static_cast<char>(altered[altered.size() / 2] ^ 1);
  for (const std::string& bytes : {altered, whole.substr(0, whole.size() / 2), std::string("x")}) {
    std::ofstream(points, std::ios::binary) << bytes;
    expectRefused(step("tile"), "tile-000001.points");
  }
  std::ofstream(points, std::ios::binary) << whole;
  ASSERT_EQ(step("tile").status, 0);
  for (const auto& [file, then] : {std::pair<std::string, const char*>{"share", "join"},
                                   {"ties", "join"},
                                   {"rows", "write"}}) {
    const std::string path = folder + "/tile-000002." + file;
    const std::string good = readFile(path);
    std::string bad = good;
    bad[bad.size() * 2 / 3] = static_cast<char>(bad[bad.size() * 2 / 3] ^ 8);
    std::ofstream(path, std::ios::binary) << bad;
    expectRefused(step(then), "tile-000002." + file);
    std::ofstream(path, std::ios::binary) << good;
    if (file == "ties") {
      ASSERT_EQ(step("join").status, 0);
    }
  }
  ASSERT_EQ(step("write").status, 0);
  EXPECT_TRUE(fs::exists(out));
}

TEST_F(Faults, AnInputThatWasChangedIsFound) {
  ASSERT_EQ(plan().status, 0);
  ASSERT_EQ(step("tile").status, 0);
  ASSERT_EQ(step("join").status, 0);
  writeDoubles(in, hollowSphere(8001, 0.0, 0.0, 0.0));
  expectRefused(step("write"), "was changed");
  expectRefused(plan(), "other inputs");
}

TEST_F(Faults, TwoRunsDoNotShareAFolder) {
  const program::WorkFolder held(folder, true);
  expectRefused(plan(), "in use by another run");
}

TEST_F(Faults, FilesOfAnotherVersionAreRefused) {
  ASSERT_EQ(plan().status, 0);
  std::string bytes = readFile(folder + "/plan");
  bytes[8] = '0';  // of the version
  std::ofstream(folder + "/plan", std::ios::binary) << bytes;
  expectRefused(step("tile"), "was written by segorient");
}

TEST_F(Faults, StepsThatComeTooEarlySayWhatIsMissing) {
  expectRefused(step("join"), "work/plan");
  ASSERT_EQ(plan().status, 0);
  expectRefused(step("join"), "before tile 0 is done");
  ASSERT_EQ(step("tile").status, 0);
  expectRefused(step("write"), "before it is joined");
}

// The plan goes first: whatever else is left of a folder that was being removed, a run begins anew.
TEST_F(Faults, AFolderThatIsHalfRemovedIsBegunAnew) {
  ASSERT_EQ(plan().status, 0);
  ASSERT_EQ(step("tile").status, 0);
  ASSERT_EQ(step("join").status, 0);
  ASSERT_EQ(step("write").status, 0);
  const std::string undisturbed = readFile(out);
  fs::remove(out);
  fs::remove(folder + "/plan");
  fs::remove(folder + "/tile-000001.points");
  const Outcome again = runProgram(
      {"orient", in, out, "-q", "--work", folder, "--memory", "1G", "--tile-points", "3000"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(readFile(out) == undisturbed);
  EXPECT_FALSE(fs::exists(folder));
}

// A folder that was no work folder keeps what it has, whatever the names.
TEST_F(Faults, FilesOfOthersStayInTheFolder) {
  fs::create_directory(folder);
  std::ofstream(folder + "/labels") << "mine";
  fs::copy(in, folder + "/input-1.ply");
  for (int run = 0; run < 2; ++run) {
    expectRefused(runProgram({"orient", folder + "/input-1.ply", out, "-q", "--work", folder,
                              "--memory", "1G", "--tile-points", "3000"}),
                  "is no work folder");
  }
  EXPECT_EQ(readFile(folder + "/labels"), "mine");
  EXPECT_EQ(readFile(folder + "/input-1.ply"), readFile(in));
}

TEST_F(Faults, CleaningCanBeRepeated) {
  ASSERT_EQ(plan().status, 0);
  EXPECT_EQ(step("clean").status, 0);
  EXPECT_FALSE(fs::exists(folder));
  EXPECT_EQ(step("clean").status, 0);
}

TEST_F(Faults, APlanOfFilesThatAreNotThereLeavesNoFolder) {
  fs::remove(in);
  expectRefused(plan(), "in.ply");
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(Faults, InputsAreNotWrittenOver) {
  const std::string inputs = scratch.file("inputs");
  fs::create_directory(inputs);
  writeDoubles(inputs + "/a.ply", hollowSphere(2000, 0.0, 0.0, 0.0));
  const std::string before = readFile(writeDoubles(inputs + "/b.ply", hollowSphere(2000, 3, 0, 0)));
  expectRefused(runProgram({"orient", inputs, inputs, "-q", "--memory", "1G"}), "is an input");
  EXPECT_TRUE(readFile(inputs + "/b.ply") == before);
}

}  // namespace
}  // namespace segorient::test
