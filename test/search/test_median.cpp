// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "common/median.h"

namespace segorient {
namespace {

float sortedMiddle(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::vector<float> randomValues(std::size_t count) {
  std::mt19937 random(7);
  std::lognormal_distribution<float> values(0.F, 2.F);
  std::vector<float> out(count);
  for (float& v : out) v = values(random);
  return out;
}

TEST(Median, OfNoneIsZero) {
  EXPECT_EQ(0.F, median({}));
}

TEST(Median, IsTheMiddleOfTheSortedValues) {
  for (const std::size_t count : {1U, 2U, 3U, 1000U, 16384U, 16385U, 100000U}) {
    const std::vector<float> values = randomValues(count);
    EXPECT_EQ(sortedMiddle(values), median(values)) << count;
  }
}

TEST(Median, OfManyEqualValues) {
  std::vector<float> values(50000, 2.F);
  EXPECT_EQ(2.F, median(values));
  for (std::size_t i = 0; i < 24000; ++i) values[i] = 1.F;
  EXPECT_EQ(2.F, median(values));
}

TEST(Median, OfFewAndOfInfinities) {
  for (std::size_t count = 1; count <= 40; ++count) {
    std::vector<float> values = randomValues(count);
    EXPECT_EQ(sortedMiddle(values), median(values)) << count;
    values[count / 2] = std::numeric_limits<float>::infinity();
    values[count / 3] = -std::numeric_limits<float>::infinity();
    EXPECT_EQ(sortedMiddle(values), median(values)) << count;
  }
}

// As the rows of a scan are; this would take an hour if passes could leave nearly all.
TEST(Median, OfValuesThatComeAgainAndAgain) {
  constexpr std::size_t kRows = 8;
  constexpr std::size_t kColumns = 500000;
  std::vector<float> values;
  for (std::size_t i = 0; i < kRows * kColumns; ++i) {
    values.push_back(std::hypot(1.F, static_cast<float>(i % kColumns) / kColumns));
  }
  EXPECT_EQ(sortedMiddle(values), median(values));
}

TEST(Median, OfNoNumbersEnds) {
  median(std::vector<float>(100, std::numeric_limits<float>::quiet_NaN()));
}

// In order, backwards, and of a few values each of which is there many times.
TEST(Median, OfValuesInOrderAndOfFewKinds) {
  for (const std::size_t count : {17U, 64U, 1000U, 4097U}) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i);
    EXPECT_EQ(sortedMiddle(values), median(values)) << count;
    std::reverse(values.begin(), values.end());
    EXPECT_EQ(sortedMiddle(values), median(values)) << count;
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i * i % 7) / 8.F - 0.5F;
    EXPECT_EQ(sortedMiddle(values), median(values)) << count;
  }
}

// Values that a regular sample sees only the extremes of.
TEST(Median, DoesNotDependOnWhatASampleSees) {
  constexpr std::size_t kCount = 64U * 1024U + 1U;  // eighths of it are seen as well
  for (const float extreme : {-1000.F, 1000.F}) {
    std::vector<float> values = randomValues(kCount);
    for (std::size_t i = 0; i < kCount; i += 64) values[i] = extreme;
    EXPECT_EQ(sortedMiddle(values), median(values)) << extreme;
  }
}

}  // namespace
}  // namespace segorient
