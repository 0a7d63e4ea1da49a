// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>

#include <cstddef>
#include <type_traits>

namespace segorient {

/// Whether all entries are of so many points: a table of another cloud may lead out of this one.
inline bool refersTo(const Neighborhoods& table, std::size_t points) {
  // Negative ones are too large as well.
  using Unsigned = std::make_unsigned_t<pcl::index_t>;
  bool outside = false;
  for (std::size_t row = 0; row < table.size() && !outside; ++row) {
    const pcl::index_t* entries = table.indices(row);
    for (int j = 0; j < table.count(row); ++j) {
      outside |= static_cast<Unsigned>(entries[j]) >= static_cast<Unsigned>(points);
    }
  }
  return !outside;
}

}  // namespace segorient
