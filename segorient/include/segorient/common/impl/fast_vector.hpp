// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace segorient {

/// Leaves new numbers as they are in memory instead of setting them to 0: for tables that are
/// written right after, where the zeros would cost as much as the table.
template <typename T>
struct UninitializedAllocator : std::allocator<T> {
  static constexpr std::align_val_t kCacheLine{64};

  template <typename U>
  struct rebind {  // NOLINT(readability-identifier-naming): the name of the standard
    using other = UninitializedAllocator<U>;
  };
  using std::allocator<T>::allocator;

  /// On a cache line: rows of 16 numbers then lie in one each.
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kCacheLine)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, kCacheLine); }

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
