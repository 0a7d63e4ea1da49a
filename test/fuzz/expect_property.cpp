// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <cstdio>
#include <cstdlib>

#include "targets.h"

namespace segorient::test {

void expectProperty(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace segorient::test
