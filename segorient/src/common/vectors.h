// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Several numbers side by side: a vector register where the compiler has types for that, and an
// array that is worked on one number at a time where it has none (or SEGORIENT_PLAIN_VECTORS asks
// for it). Each operation is rounded as one of single numbers is, so results do not depend on it.
//
//   SEGORIENT_VECTOR (T, n)           n numbers of type T; operators as T has them, comparisons
//   give
//                                     0 or -1 in integers of the same size
//   SEGORIENT_CHOSEN (m, yes, no)     number by number `yes` where m is not 0
//   SEGORIENT_BITS_AS (V, v)          the same bits as vector type V
//   SEGORIENT_CONVERTED (v, V)        the same values as vector type V
//   SEGORIENT_SHUFFLED (a, b, ...)    numbers of a and b by their places, those of b after a's
#pragma once

#include "common/compiler.h"

#if SEGORIENT_GNU_COMPILER && !defined(SEGORIENT_PLAIN_VECTORS)

#define SEGORIENT_VECTOR(type, n) type __attribute__((vector_size(sizeof(type) * (n))))
#define SEGORIENT_CHOSEN(mask, yes, no) ((mask) ? (yes) : (no))
#define SEGORIENT_BITS_AS(type, v) reinterpret_cast<type>(v)
#define SEGORIENT_CONVERTED(v, type) __builtin_convertvector(v, type)
#define SEGORIENT_SHUFFLED(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)

// Vectors are passed between inlined functions of one file only, so their calling convention is of
// no consequence.
#if !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

#else

#include <cstddef>
#include <type_traits>

namespace segorient {

template <typename T, std::size_t kSize>
struct PlainVector {
  T lane[kSize];

  using Integer = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  using Mask = PlainVector<Integer, kSize>;

  T& operator[](std::size_t i) { return lane[i]; }
  const T& operator[](std::size_t i) const { return lane[i]; }

  template <typename Operation>
  static PlainVector each(const Operation& operation) {
    PlainVector out{};
    for (std::size_t i = 0; i < kSize; ++i) out.lane[i] = static_cast<T>(operation(i));
    return out;
  }
  friend PlainVector operator-(const PlainVector& a) {
    return each([&](std::size_t i) { return -a.lane[i]; });
  }
  friend PlainVector operator~(const PlainVector& a) {
    return each([&](std::size_t i) { return ~a.lane[i]; });
  }

#define SEGORIENT_LANEWISE(result, op)                                          \
  friend result operator op(const PlainVector& a, const PlainVector& b) {       \
    return result::each([&](std::size_t i) { return a.lane[i] op b.lane[i]; }); \
  }                                                                             \
  friend result operator op(const PlainVector& a, T b) {                        \
    return result::each([&](std::size_t i) { return a.lane[i] op b; });         \
  }                                                                             \
  friend result operator op(T a, const PlainVector& b) {                        \
    return result::each([&](std::size_t i) { return a op b.lane[i]; });         \
  }
#define SEGORIENT_COMPARED(op)                                                         \
  friend Mask operator op(const PlainVector& a, const PlainVector& b) {                \
    return Mask::each([&](std::size_t i) { return a.lane[i] op b.lane[i] ? -1 : 0; }); \
  }                                                                                    \
  friend Mask operator op(const PlainVector& a, T b) {                                 \
    return Mask::each([&](std::size_t i) { return a.lane[i] op b ? -1 : 0; });         \
  }                                                                                    \
  friend Mask operator op(T a, const PlainVector& b) {                                 \
    return Mask::each([&](std::size_t i) { return a op b.lane[i] ? -1 : 0; });         \
  }
  SEGORIENT_LANEWISE(PlainVector, +)
  SEGORIENT_LANEWISE(PlainVector, -)
  SEGORIENT_LANEWISE(PlainVector, *)
  SEGORIENT_LANEWISE(PlainVector, /)
  SEGORIENT_LANEWISE(PlainVector, &)
  SEGORIENT_LANEWISE(PlainVector, |)
  SEGORIENT_LANEWISE(PlainVector, >>)
  SEGORIENT_COMPARED(<)
  SEGORIENT_COMPARED(>)
  SEGORIENT_COMPARED(<=)
  SEGORIENT_COMPARED(>=)
  SEGORIENT_COMPARED(==)
  SEGORIENT_COMPARED(!=)
#undef SEGORIENT_COMPARED
#undef SEGORIENT_LANEWISE

  template <typename Other>
  PlainVector& operator+=(const Other& b) {
    return *this = *this + b;
  }
  template <typename Other>
  PlainVector& operator-=(const Other& b) {
    return *this = *this - b;
  }
  template <typename Other>
  PlainVector& operator*=(const Other& b) {
    return *this = *this * b;
  }
  template <typename Other>
  PlainVector& operator&=(const Other& b) {
    return *this = *this & b;
  }
};

template <typename M, typename T, std::size_t kSize>
PlainVector<T, kSize> chosen(const PlainVector<M, kSize>& mask, const PlainVector<T, kSize>& yes,
                             const PlainVector<T, kSize>& no) {
  return PlainVector<T, kSize>::each(
      [&](std::size_t i) { return mask.lane[i] != 0 ? yes.lane[i] : no.lane[i]; });
}

template <typename To, typename From>
To bitsAs(const From& from) {
  static_assert(sizeof(To) == sizeof(From), "the same number of bits");
  To to;
  copyBytes(&to, &from, sizeof(to));
  return to;
}

template <typename To, typename From>
To converted(const From& from) {
  return To::each([&](std::size_t i) { return from.lane[i]; });
}

template <typename T, std::size_t kSize, typename... Places>
PlainVector<T, sizeof...(Places)> shuffled(const PlainVector<T, kSize>& a,
                                           const PlainVector<T, kSize>& b, Places... places) {
  const std::size_t from[] = {static_cast<std::size_t>(places)...};
  return PlainVector<T, sizeof...(Places)>::each(
      [&](std::size_t i) { return from[i] < kSize ? a.lane[from[i]] : b.lane[from[i] - kSize]; });
}

}  // namespace segorient

#define SEGORIENT_VECTOR(type, n) segorient::PlainVector<type, (n)>
#define SEGORIENT_CHOSEN(mask, yes, no) segorient::chosen(mask, yes, no)
#define SEGORIENT_BITS_AS(type, v) segorient::bitsAs<type>(v)
#define SEGORIENT_CONVERTED(v, type) segorient::converted<type>(v)
#define SEGORIENT_SHUFFLED(a, b, ...) segorient::shuffled(a, b, __VA_ARGS__)

#endif
