// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "targets.h"

// One program a target: the build says which.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  segorient::test::SEGORIENT_FUZZ_TARGET(data, size);
  return 0;
}
