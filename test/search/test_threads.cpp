// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "brute_force.h"
#include "common/parallel_for.h"
#include "common/parts.h"
#include "common/threads.h"
#include "search_clouds.h"

namespace segorient::test {
namespace {

constexpr int kMost = std::numeric_limits<int>::max();

TEST(Threads, NeverMoreThanASystemGives) {
  EXPECT_EQ(resolveThreads(-1), 1);
  EXPECT_GE(resolveThreads(0), 1);
  EXPECT_EQ(resolveThreads(3), 3);
  EXPECT_GE(resolveThreads(kMost), 64);
  EXPECT_LE(resolveThreads(kMost), 4096);
  EXPECT_EQ(resolveThreads(65536), resolveThreads(kMost));
}

TEST(Threads, AsManyAsTheWorkIsWorth) {
  const int all = resolveThreads(0);
  EXPECT_EQ(resolveThreads(0, 0, 1000.0), 1);
  EXPECT_EQ(resolveThreads(0, 1000, 1000.0), 1) << "a millisecond";
  EXPECT_EQ(resolveThreads(0, 1000000000, 1000.0), all);
  EXPECT_LE(resolveThreads(0, 2000, 10000.0), 4) << "20 milliseconds";
  EXPECT_EQ(resolveThreads(5, 1, 1.0), 5) << "who asks for them gets them";
}

// Whatever the threads do first, the message is the same.
TEST(Threads, WhatTheFirstOfTheFailedPartsThrowsIsThrown) {
  const Parts parts(100, 4, 1.0);
  std::string message;
  try {
    parts.forEach([](std::size_t part) {
      if (part > 0) throw std::runtime_error(std::to_string(part));
    });
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  EXPECT_EQ(message, "1");
}

TEST(ParallelFor, CallsEachOnceAndMakesSpacesOnlyForThreadsThatWork) {
  for (const double nanoseconds : {0.0, 1.0, 5e4, 1e9}) {
    for (const std::size_t count : {0U, 1U, 3U, 250000U}) {
      std::vector<std::atomic<int>> calls(count);
      std::atomic<int> spaces{0};
      parallelFor(
          count, 4, nanoseconds, [&spaces] { return ++spaces; },
          [&calls](std::size_t i, int) { ++calls[i]; });
      const bool once =
          std::all_of(calls.begin(), calls.end(), [](const auto& c) { return c == 1; });
      EXPECT_TRUE(once) << count << " of " << nanoseconds << " ns";
      EXPECT_LE(spaces, std::min<std::size_t>(4, count));
      EXPECT_EQ(spaces > 0, count > 0);
    }
  }
}

TEST(ParallelFor, ThrowsWhatTheFirstCallThrows) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::atomic<int> calls{0};
    try {
      parallelFor(10000, 4, 1e5, [&calls](std::size_t i) {
        ++calls;
        if (i % 7 == 5) throw std::runtime_error(std::to_string(i));
      });
      ADD_FAILURE() << "nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "5");
    }
    EXPECT_LT(calls, 10000) << "goes on in vain";
  }
}

TEST(ParallelFor, ASpaceThatCannotBeMadeIsAnError) {
  const auto fail = []() -> int { throw std::bad_alloc(); };
  EXPECT_THROW(parallelFor(10, 4, 1e5, fail, [](std::size_t, int) {}), std::bad_alloc);
}

TEST(Threads, AnyNumberFindsTheSame) {
  const SearchCloud cloud = searchClouds(3000)[1];
  Neighborhoods expected;
  for (const int threads : {1, 2, 65, 65536, kMost}) {
    search::MedianHashIndex index;
    search::MedianHashIndex::Options options;
    options.threads = threads;
    options.region_size = 100;
    index.build(cloud.view(), nullptr, options);
    Neighborhoods table;
    index.nearestKAll(7, table);
    if (threads == 1) index.nearestKAll(7, expected);
    for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_EQ(row(table, i), row(expected, i));
  }
}

}  // namespace
}  // namespace segorient::test
