// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace segorient {

/// Memory for a table that is written right after, on a cache line. Large ones are in large pages
/// where the system has them: the first write to each page of 4096 bytes costs as much as filling
/// it. \throw std::bad_alloc
SEGORIENT_SEARCH_EXPORT void* allocateTable(std::size_t bytes);
/// \param bytes as it was allocated with
SEGORIENT_SEARCH_EXPORT void freeTable(void* at, std::size_t bytes);

/// Leaves new numbers as they are in memory instead of setting them to 0: for tables that are
/// written right after, where the zeros would cost as much as the table.
template <typename T>
struct UninitializedAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {  // NOLINT(readability-identifier-naming): the name of the standard
    using other = UninitializedAllocator<U>;
  };
  using std::allocator<T>::allocator;

  T* allocate(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocateTable(n * sizeof(T)));
  }
  void deallocate(T* at, std::size_t n) { freeTable(at, n * sizeof(T)); }

  template <typename U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
  }
};

/// A vector whose resize() does not set new elements.
template <typename T>
using FastVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace segorient
