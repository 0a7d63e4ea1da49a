// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Sums over dipoles, kSums side by side, for one instruction set; see lanes.inl.

#include "common/lanes.inl"

/// That hold kSums.
constexpr std::size_t kRegisters = kSums / kWidth;

/// One sum by its parts.
struct Part {
  Lanes of[kRegisters] = {};

  void storeTo(std::array<float, kSums>& out) const {
    for (std::size_t r = 0; r < kRegisters; ++r) store(&out[r * kWidth], of[r]);
  }
};

/// From a place to dipoles, and the square of how far they are, smeared.
struct Way {
  Lanes x, y, z, square;

  Way(const Dipoles& from, std::size_t i, const float* at, float r2)
      : x(load(from.x + i) - at[0]), y(load(from.y + i) - at[1]), z(load(from.z + i) - at[2]) {
    square = x * x + y * y + z * z + r2;
  }
};

/// Calls for registers full of dipoles. The list ends with dipoles that are 0.
template <typename Add>
inline void forRegisters(const Dipoles& from, Add&& add) {
  for (std::size_t i = 0; i < from.count; i += kSums) {
    for (std::size_t r = 0; r < kRegisters; ++r) add(i + r * kWidth, r);
  }
}

inline void addNumbers(const Dipoles& from, const float* at, float r2, Sums& sums) {
  const Dipoles d = from;
  Part sum;
  forRegisters(d, [&](std::size_t i, std::size_t r) SEGORIENT_INLINED {
    const Way way(d, i, at, r2);
    const Lanes inverse = 1.F / way.square;
    const Lanes weight = inverse * squareRoot(inverse);
    sum.of[r] +=
        weight * (load(d.mx + i) * way.x + load(d.my + i) * way.y + load(d.mz + i) * way.z);
  });
  sum.storeTo(sums.x);
}

inline void addDescents(const Dipoles& from, const float* at, float r2, Sums& sums) {
  const Dipoles d = from;
  Part x, y, z;
  forRegisters(d, [&](std::size_t i, std::size_t r) SEGORIENT_INLINED {
    const Way way(d, i, at, r2);
    const Lanes3 m{load(d.mx + i), load(d.my + i), load(d.mz + i)};
    const Lanes inverse = 1.F / way.square;
    const Lanes weight = inverse * squareRoot(inverse);
    const Lanes along = 3.F * inverse * (m.x * way.x + m.y * way.y + m.z * way.z);
    x.of[r] += weight * (m.x - along * way.x);
    y.of[r] += weight * (m.y - along * way.y);
    z.of[r] += weight * (m.z - along * way.z);
  });
  x.storeTo(sums.x);
  y.storeTo(sums.y);
  z.storeTo(sums.z);
}

inline void addPulls(const Dipoles& from, const float* at, float r2, Sums& sums) {
  const Dipoles d = from;
  Part x, y, z;
  forRegisters(d, [&](std::size_t i, std::size_t r) SEGORIENT_INLINED {
    const Way way(d, i, at, r2);
    const Lanes inverse = 1.F / way.square;
    const Lanes weight = load(d.mx + i) * inverse * squareRoot(inverse);
    x.of[r] -= weight * way.x;
    y.of[r] -= weight * way.y;
    z.of[r] -= weight * way.z;
  });
  x.storeTo(sums.x);
  y.storeTo(sums.y);
  z.storeTo(sums.z);
}
