// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace segorient {

/// A label or another number that is not negative, to index with.
inline std::size_t at(std::int32_t number) {
  return static_cast<std::size_t>(number);
}

}  // namespace segorient
