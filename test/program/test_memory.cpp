// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/orientation/pipeline.h>

#include <limits>
#include <sstream>
#include <string>

#include "io/errors.h"
#include "support/memory.h"

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
  try {
    requireMemory("a.pcd", 3'000'000'000, 1'000'000'000);
    FAIL() << "must throw";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()),
              "a.pcd: takes about 3.0 GB of memory to work on, and 1.0 GB are free");
  }
}

TEST(Memory, NeedGrowsWithPointsAndNeighbours) {
  PipelineOptions few;
  few.k = 8;
  PipelineOptions many;
  many.k = 64;
  EXPECT_EQ(expectedMemory(0, few), 0U);
  EXPECT_EQ(expectedMemory(2'000'000, few), 2 * expectedMemory(1'000'000, few));
  EXPECT_EQ(expectedMemory(1000, many) - expectedMemory(1000, few), 1000U * 56U * 4U);
  EXPECT_LE(expectedMemory(1'000'000, {}), 300'000'000U) << "what the README promises";
}

}  // namespace
}  // namespace segorient::program
