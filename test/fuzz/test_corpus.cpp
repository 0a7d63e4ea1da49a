// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// What fuzzing found worth keeping, once more: inputs that reach new code, and those that once
// failed. A property that does not hold ends the process.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "targets.h"

namespace segorient::test {
namespace {

void replay(const std::string& name, void (*target)(const std::uint8_t*, std::size_t)) {
  const std::filesystem::path directory = std::filesystem::path(SEGORIENT_FUZZ_CORPUS) / name;
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    std::cout << entry.path().filename() << std::endl;  // known if the process ends
    target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++count;
  }
  EXPECT_GE(count, 50U);
}

TEST(FuzzCorpus, Search) {
  replay("search", fuzzSearch);
}

TEST(FuzzCorpus, Pipeline) {
  replay("pipeline", fuzzPipeline);
}

#ifdef SEGORIENT_FUZZ_PROGRAM
TEST(FuzzCorpus, Program) {
  replay("program", fuzzProgram);
}

TEST(FuzzCorpus, Scans) {
  replay("scans", fuzzScans);
}
#endif

}  // namespace
}  // namespace segorient::test
