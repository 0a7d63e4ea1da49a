// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/median.h"

#include <algorithm>
#include <cstddef>

namespace segorient {

float median(std::vector<float> values) {
  if (values.empty()) return 0.F;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace segorient
