// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "io/errors.h"
#include "support/memory.h"
#include "support/stage_memory.h"

namespace segorient::program {
namespace {

TEST(Memory, IsReadInKilobytes) {
  std::istringstream meminfo("MemTotal:  25000000 kB\nMemFree: 7 kB\nMemAvailable:    2048 kB\n");
  EXPECT_EQ(availableIn(meminfo), 2048U * 1024U);
}

TEST(Memory, IsWithoutLimitWhereNothingSaysOne) {
  std::istringstream empty;
  EXPECT_EQ(availableIn(empty), std::numeric_limits<std::size_t>::max());
}

TEST(Memory, ThisMachineHasSome) {
  EXPECT_GT(availableMemory(), 1U << 20U);
}

TEST(Memory, TooLittleIsAnErrorThatSaysHowMuch) {
  EXPECT_NO_THROW(requireMemory("a.pcd", 1000, 1000));
  const auto said = [](std::size_t needed, std::size_t available) {
    try {
      requireMemory("a.pcd", needed, available);
    } catch (const FileError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(said(3'000'000'000, 1'000'000'000),
            "a.pcd: takes about 3.0 GB of memory to work on, and 1.0 GB are free");
  EXPECT_EQ(said(30'000'000, 9'000'000),
            "a.pcd: takes about 30 MB of memory to work on, and 9 MB are free");
}

TEST(Memory, NeedGrowsWithPointsAndNeighbours) {
  PipelineOptions few;
  few.k = 8;
  PipelineOptions many;
  many.k = 64;
  EXPECT_EQ(expectedMemory(0, few), 0U);
  EXPECT_EQ(expectedMemory(2'000'000, few), 2 * expectedMemory(1'000'000, few));
  // The table, and that of smoothed positions.
  EXPECT_EQ(expectedMemory(1000, many) - expectedMemory(1000, few), 1000U * 56U * 4U * 2U);
  EXPECT_LE(expectedMemory(1'000'000, {}), 470'000'000U) << "with noise";
  PipelineOptions seen;
  OrientationHints hints;
  hints.has_viewpoint = true;
  seen.orientation.hints = std::make_shared<OrientationHints>(hints);
  EXPECT_GT(expectedMemory(1'000'000, seen), expectedMemory(1'000'000, {}));
}

constexpr std::size_t kMegabyte = 1024 * 1024;

// Memory of the system itself: what goes through malloc may stay in the process.
void useFor(StageMemory& memory, const std::string& stage, std::size_t bytes) {
  memory.begin(stage);
  void* pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(pages, MAP_FAILED);
  std::memset(pages, 1, bytes);
  // As stages do: long enough to be seen where the mark is not raised.
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  munmap(pages, bytes);
}

TEST(StageMemory, EachStageHasItsOwnPeak) {
  StageMemory memory(true);
  useFor(memory, "large", 192 * kMegabyte);
  useFor(memory, "none", kMegabyte);
  useFor(memory, "small", 64 * kMegabyte);
  memory.end();
  memory.end();  // once more changes nothing
  ASSERT_EQ(memory.stages().size(), 3U);
  EXPECT_EQ(memory.stages()[0].first, "large");
  EXPECT_EQ(memory.stages()[1].first, "none");
  EXPECT_EQ(memory.stages()[2].first, "small");
  const auto over_none = [&](std::size_t i) {
    return static_cast<double>(memory.stages()[i].second) / kMegabyte -
           static_cast<double>(memory.stages()[1].second) / kMegabyte;
  };
  EXPECT_NEAR(over_none(0), 191.0, 4.0);
  EXPECT_NEAR(over_none(2), 63.0, 4.0);
  EXPECT_EQ(memory.most(), memory.stages()[0].second);
}

// Nothing is sampled then, but the mark costs nothing.
TEST(StageMemory, WithoutWatchingIsTheMostSoFar) {
  StageMemory memory(false);
  useFor(memory, "first", 64 * kMegabyte);
  useFor(memory, "second", kMegabyte);
  memory.end();
  ASSERT_EQ(memory.stages().size(), 2U);
  EXPECT_GE(memory.stages()[0].second, 64 * kMegabyte);
  EXPECT_EQ(memory.stages()[1].second, memory.stages()[0].second);
}

// Whoever measures the process from outside must not see less.
TEST(StageMemory, LeavesTheMarkOfTheProcessAlone) {
  StageMemory memory(true);
  useFor(memory, "first", 192 * kMegabyte);
  useFor(memory, "second", kMegabyte);
  memory.end();
  rusage usage{};
  ASSERT_EQ(getrusage(RUSAGE_SELF, &usage), 0);
  EXPECT_GE(static_cast<std::size_t>(usage.ru_maxrss) * 1024, memory.most());
  EXPECT_LT(memory.stages()[1].second, memory.most());
}

TEST(StageMemory, StageThatComesAgainKeepsItsLargest) {
  StageMemory memory(true);
  useFor(memory, "first", 64 * kMegabyte);
  useFor(memory, "second", kMegabyte);
  useFor(memory, "first", kMegabyte);
  memory.end();
  ASSERT_EQ(memory.stages().size(), 2U);
  EXPECT_GE(memory.stages()[0].second, 64 * kMegabyte);
  EXPECT_EQ(memory.most(), memory.stages()[0].second);
}

TEST(StageMemory, HearsOfStagesAndPassesThemOn) {
  StageMemory memory(true);
  std::string heard;
  const PipelineProgress progress =
      memory.watch([&heard](const char* stage, double) { heard += std::string(stage) + " "; });
  progress("search", 0.0);
  progress("search", 0.1);
  progress("normals", 0.2);
  memory.watch({})("output", 1.0);  // nobody listens
  memory.end();
  EXPECT_EQ(heard, "search search normals ");
  ASSERT_EQ(memory.stages().size(), 3U);
  EXPECT_EQ(memory.stages()[2].first, "output");
  EXPECT_GT(memory.stages()[2].second, kMegabyte);
}

}  // namespace
}  // namespace segorient::program
