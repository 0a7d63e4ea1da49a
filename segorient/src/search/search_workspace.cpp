// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "search/search_workspace.h"

namespace segorient::search {

Workspace& workspace() {
  thread_local Workspace instance;
  return instance;
}

float pruneFactor(float epsilon) {
  if (!(epsilon > 0.0F)) return 1.0F;  // only a number above 0 is a tolerance
  const float bound = 1.0F + epsilon;
  return 0.999999F / (bound * bound);
}

}  // namespace segorient::search
