// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Every instruction set must give the same bytes as plain loops.
#include <gtest/gtest.h>
#include <segorient/search/median_hash_index.h>

#include <cstdlib>
#include <string>

#include "search_clouds.h"

namespace segorient::test {
namespace {

using search::MedianHashIndex;

// All that the kernels compute of a cloud.
struct Results {
  std::vector<pcl::index_t> indices;
  std::vector<float> distances;

  bool operator==(const Results& o) const {
    return indices == o.indices && distances == o.distances;
  }
};

void append(Results& all, const pcl::index_t* indices, const float* distances, int count) {
  all.indices.insert(all.indices.end(), indices, indices + count);
  all.distances.insert(all.distances.end(), distances, distances + count);
}

Results compute(const SearchCloud& cloud, const char* instruction_set) {
  setenv("SEGORIENT_SIMD", instruction_set, 1);
  MedianHashIndex::Options options;
  options.region_size = 300;
  MedianHashIndex index;
  index.build(cloud.view(), nullptr, options);
  unsetenv("SEGORIENT_SIMD");
  Results all;
  for (const int k : {1, 7, 20, 65}) {
    Neighborhoods table;
    index.nearestKAll(k, table);
    for (std::size_t i = 0; i < table.size(); ++i) {
      append(all, table.indices(i), table.sqrDistances(i), table.count(i));
    }
  }
  std::vector<pcl::index_t> indices(200);
  std::vector<float> distances(200);
  for (std::size_t i = 0; i < cloud.size(); i += 37) {
    const float* query = cloud.view()[i];
    for (const int k : {3, 40, 200}) {
      for (const float epsilon : {0.0F, 0.7F}) {
        const int found = index.nearestK(query, k, indices.data(), distances.data(), epsilon);
        append(all, indices.data(), distances.data(), found);
      }
    }
    std::vector<pcl::index_t> inside;
    std::vector<float> squared;
    const int found = index.radius(query, 0.15, inside, squared, 0, true);
    append(all, inside.data(), squared.data(), found);
  }
  return all;
}

TEST(InstructionSet, CanBeForced) {
  const auto chosen = [](const char* wanted) {
    setenv("SEGORIENT_SIMD", wanted, 1);
    MedianHashIndex index;
    unsetenv("SEGORIENT_SIMD");
    return std::string(index.instructionSet());
  };
  EXPECT_EQ(chosen("scalar"), "scalar");
#ifdef __x86_64__
  EXPECT_EQ(chosen("sse2"), "sse2");
  EXPECT_EQ(chosen("avx2"), __builtin_cpu_supports("avx2") != 0 ? "avx2" : "sse2");
  const bool has512 =
      __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0;
  EXPECT_EQ(chosen("avx512"), has512 ? "avx512" : chosen("avx2"));
  EXPECT_EQ(chosen("no such"), chosen("avx512"));
#endif
}

class Simd : public testing::TestWithParam<SearchCloud> {};

TEST_P(Simd, SameBytesAsPlainLoops) {
  const Results plain = compute(GetParam(), "scalar");
  ASSERT_FALSE(plain.indices.empty());
  EXPECT_TRUE(compute(GetParam(), "sse2") == plain);
  EXPECT_TRUE(compute(GetParam(), "avx2") == plain);
  EXPECT_TRUE(compute(GetParam(), "avx512") == plain);
  EXPECT_TRUE(compute(GetParam(), "") == plain) << "the best that this machine has";
}

INSTANTIATE_TEST_SUITE_P(Clouds, Simd, testing::ValuesIn(searchClouds(1200)));

}  // namespace
}  // namespace segorient::test
