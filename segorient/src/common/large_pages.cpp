// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/impl/fast_vector.hpp>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace segorient {
namespace {

// Of x86 and of most ARM systems.
constexpr std::size_t kLargePage = std::size_t{1} << 21;
// Of less, small pages serve as well.
constexpr std::size_t kLeastLarge = 4 * kLargePage;
// Rows of 16 numbers then lie in one line of the cache each.
constexpr std::align_val_t kCacheLine{64};

std::align_val_t alignmentFor(std::size_t bytes) {
  return bytes < kLeastLarge ? kCacheLine : std::align_val_t{kLargePage};
}

}  // namespace

void* allocateTable(std::size_t bytes) {
  void* at = ::operator new(bytes, alignmentFor(bytes));
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  // A wish: where there are none to give, pages are small. Whole ones only, as the last one may be
  // shared with other memory.
  if (bytes >= kLeastLarge) madvise(at, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
#endif
  return at;
}

void freeTable(void* at, std::size_t bytes) {
  ::operator delete(at, alignmentFor(bytes));
}

}  // namespace segorient
