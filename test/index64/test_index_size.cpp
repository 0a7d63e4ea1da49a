// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <pcl/types.h>

namespace segorient::test {
namespace {

TEST(IndexSize, IsWhatThisProgramIsToTest) {
  EXPECT_EQ(sizeof(pcl::index_t), 8U);
}

}  // namespace
}  // namespace segorient::test
