// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/parallel_for.h"
#include "common/parts.h"

namespace segorient {

/// std::sort() on all threads. Whatever `less` finds equal must be the same, as how the items are
/// parted depends on the number of threads.
template <typename T, typename Less>
void sortAll(std::vector<T>& items, int threads, const Less& less) {
  constexpr double kItemTime = 100.0;  // ns, see resolveThreads()
  const Parts parts(items.size(), threads, kItemTime);
  const auto at = [&](std::size_t part) {
    return items.begin() + static_cast<std::ptrdiff_t>(parts.begin(std::min(part, parts.count())));
  };
  parts.forEach([&](std::size_t part) { std::sort(at(part), at(part + 1), less); });
  for (std::size_t width = 1; width < parts.count(); width *= 2) {
    const std::size_t merges = (parts.count() + 2 * width - 1) / (2 * width);
    const double time = timeOfEach(merges, items.size(), kItemTime);
    parallelFor(merges, threads, time, [&](std::size_t merge) {
      const std::size_t first = 2 * width * merge;
      std::inplace_merge(at(first), at(first + width), at(first + 2 * width), less);
    });
  }
}

}  // namespace segorient
