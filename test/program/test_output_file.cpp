// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdio>

#include "io/errors.h"
#include "io/output_file.h"
#include "scratch_directory.h"
#include "support/silence.h"

namespace segorient::test {
namespace {

using program::FileError;
using program::OutputFile;

TEST(OutputFile, IsThereWholeOrNotAtAll) {
  const ScratchDirectory directory;
  const std::string path = directory.write("out.pcd", "before");
  {
    OutputFile file(path);
    file.write("half");
  }
  EXPECT_EQ(readFile(path), "before");
  EXPECT_EQ(directory.entries(), 1U);
  OutputFile file(path);
  file.write("after");
  EXPECT_EQ(readFile(path), "before");
  file.commit();
  EXPECT_EQ(readFile(path), "after");
  EXPECT_EQ(directory.entries(), 1U);
}

TEST(OutputFile, KeepsLinksAndPermissions) {
  const ScratchDirectory directory;
  const std::string path = directory.write("out.pcd", "before");
  std::filesystem::create_symlink(path, directory.file("link.pcd"));
  chmod(path.c_str(), 0640);
  OutputFile file(directory.file("link.pcd"));
  file.write("after");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(directory.file("link.pcd")));
  EXPECT_EQ(readFile(path), "after");
  struct stat info {};
  stat(path.c_str(), &info);
  EXPECT_EQ(info.st_mode & 0777, 0640U);
}

TEST(OutputFile, SaysAtOnceWhatCannotBeWritten) {
  const ScratchDirectory directory;
  EXPECT_THROW(OutputFile(directory.file("no/such/out.pcd")), FileError);
  EXPECT_THROW(OutputFile(directory.file("")), FileError);
  for (const char* device : {"/dev/null", "/dev/full"}) {
    EXPECT_THROW(OutputFile{device}, FileError) << device;
  }
  EXPECT_THROW(OutputFile(""), FileError);
}

// Ends the process: 0 if the limit, which stands for a full disk, was a FileError.
[[noreturn]] void writeTooMuch(const std::string& path) {
  program::installSignalHandlers();
  const rlimit limit{1 << 16, 1 << 16};
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    OutputFile file(path);
    file.write(std::string(1 << 18, 'x'));
    file.commit();
  } catch (const FileError&) {
    std::_Exit(0);
  }
  std::_Exit(1);
}

TEST(OutputFile, AFullDiskIsAnErrorAndLeavesWhatWasThere) {
  const ScratchDirectory directory;
  const std::string path = directory.write("out.pcd", "before");
  EXPECT_EXIT(writeTooMuch(path), testing::ExitedWithCode(0), "");
  EXPECT_EQ(readFile(path), "before");
}

[[noreturn]] void beKilledHalfWay(const std::string& path) {
  OutputFile file(path);
  file.write(std::string(1 << 18, 'x'));
  std::raise(SIGKILL);
  std::_Exit(1);
}

TEST(OutputFile, AProcessThatIsKilledLeavesNothing) {
  const ScratchDirectory directory;
  const int nameless = open(directory.file("").c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (nameless < 0) GTEST_SKIP() << "a file system without files that have no name";
  close(nameless);
  const std::string path = directory.write("out.pcd", "before");
  EXPECT_EXIT(beKilledHalfWay(path), testing::KilledBySignal(SIGKILL), "");
  EXPECT_EQ(readFile(path), "before");
  EXPECT_EQ(directory.entries(), 1U);
}

// A name that a process with the same number left is nobody's to take.
TEST(OutputFile, TakesAnotherNameWhereOneIsThere) {
  const ScratchDirectory directory;
  const std::string path = directory.file("out.pcd");
  const std::string taken =
      directory.write("out.pcd." + std::to_string(getpid()) + "-0", "another's");
  OutputFile file(path);
  file.write("mine");
  file.commit();
  EXPECT_EQ(readFile(path), "mine");
  EXPECT_EQ(readFile(taken), "another's");
  EXPECT_EQ(directory.entries(), 2U);
}

TEST(OutputFile, FinishedIsNotYetThere) {
  const ScratchDirectory directory;
  const std::string path = directory.write("out.pcd", "before");
  OutputFile file(path);
  file.write("after");
  file.finish();
  EXPECT_EQ(readFile(path), "before");
  file.finish();
  file.commit();
  EXPECT_EQ(readFile(path), "after");
  EXPECT_EQ(directory.entries(), 1U);
}

// Of two files that belong together, neither is there if one of them is too large for the disk.
[[noreturn]] void writeTwo(const std::string& path, const std::string& other) {
  program::installSignalHandlers();
  const rlimit limit{1 << 12, 1 << 12};
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    OutputFile file(path);
    OutputFile report(other);
    file.write("small");
    // Less than the buffer that it waits in: the disk is asked for it when the file is finished.
    report.write(std::string((1 << 12) - 1, 'x'));
    report.write("xx");
    report.finish();
    file.commit();
  } catch (const FileError&) {
    std::_Exit(0);
  }
  std::_Exit(1);
}

TEST(OutputFile, BothOrNone) {
  const ScratchDirectory directory;
  EXPECT_EXIT(writeTwo(directory.file("out.pcd"), directory.file("report.json")),
              testing::ExitedWithCode(0), "");
  EXPECT_EQ(directory.entries(), 0U);
}

void interruptTwoFiles(const std::string& path, const std::string& other) {
  program::installSignalHandlers();
  OutputFile file(path);
  OutputFile report(other);
  file.write("half");
  std::raise(SIGINT);
}

TEST(OutputFile, ASignalLeavesNoHalfFile) {
  const ScratchDirectory directory;
  EXPECT_EXIT(interruptTwoFiles(directory.file("out.pcd"), directory.file("report.json")),
              testing::KilledBySignal(SIGINT), "");
  EXPECT_EQ(directory.entries(), 0U);
}

TEST(Silence, NothingGetsOutWhileItLasts) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::printf("before ");
  {
    const program::Silence silence;
    std::printf("within");
    std::fprintf(stderr, "within");
  }
  std::printf("after");
  std::fprintf(stderr, "after");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "before after");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "after");
}

}  // namespace
}  // namespace segorient::test
