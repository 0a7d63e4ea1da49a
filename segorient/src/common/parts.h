// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>

#include "common/parallel_for.h"

namespace segorient {

/// Parts of a range, one for each thread that it is worth; nothing that is made of them may depend
/// on how many there are.
class Parts {
 public:
  /// \param size of the range \param threads and \param nanoseconds see resolveThreads()
  Parts(std::size_t size, int threads, double nanoseconds)
      : size_(size), count_(static_cast<std::size_t>(resolveThreads(threads, size, nanoseconds))) {}

  std::size_t count() const { return count_; }
  std::size_t begin(std::size_t part) const { return size_ * part / count_; }
  std::size_t end(std::size_t part) const { return begin(part + 1); }

  /// Calls work(part) for each of them, on a thread of its own. Throws what the first of them
  /// throws.
  template <typename Work>
  void forEach(const Work& work) const {
    constexpr double kAtOnce = 1e9;  // ns: one at a time
    parallelFor(count_, static_cast<int>(count_), kAtOnce, work);
  }

 private:
  std::size_t size_;
  std::size_t count_;
};

}  // namespace segorient
