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

/// A vector's.
struct Parts {
  Part x, y, z;

  void add(std::size_t r, Lanes weight, const Lanes3& v) {
    x.of[r] += weight * v.x;
    y.of[r] += weight * v.y;
    z.of[r] += weight * v.z;
  }
  void storeTo(Sums& out) const {
    x.storeTo(out.x);
    y.storeTo(out.y);
    z.storeTo(out.z);
  }
};

/// From a place to dipoles.
struct Way {
  Lanes3 d;
  Lanes inverse;  ///< of the square of how far they are, smeared

  Way(const Dipoles& from, std::size_t i, const float* at, float r2)
      : d{load(from.x + i) - at[0], load(from.y + i) - at[1], load(from.z + i) - at[2]},
        inverse(1.F / (dot(d, d) + r2)) {}
};

inline Lanes3 momentsOf(const Dipoles& from, std::size_t i) {
  return {load(from.mx + i), load(from.my + i), load(from.mz + i)};
}

/// Calls for registers full of dipoles. The list ends with dipoles that are 0.
template <typename Add>
inline void forRegisters(const Dipoles& from, Add&& add) {
  for (std::size_t i = 0; i < from.count; i += kSums) {
    for (std::size_t r = 0; r < kRegisters; ++r) add(i + r * kWidth, r);
  }
}

inline void addNumbers(const Dipoles& from, const float* at, float r2, Sums& sums) {
  Part sum;
  forRegisters(from, [&](std::size_t i, std::size_t r) SEGORIENT_INLINED {
    const Way way(from, i, at, r2);
    const Lanes weight = way.inverse * squareRoot(way.inverse);
    sum.of[r] += weight * dot(momentsOf(from, i), way.d);
  });
  sum.storeTo(sums.x);
}

inline void addDescents(const Dipoles& from, const float* at, float r2, Sums& sums) {
  Parts parts;
  forRegisters(from, [&](std::size_t i, std::size_t r) SEGORIENT_INLINED {
    const Way way(from, i, at, r2);
    const Lanes3 m = momentsOf(from, i);
    const Lanes weight = way.inverse * squareRoot(way.inverse);
    const Lanes along = 3.F * way.inverse * dot(m, way.d);
    parts.add(r, weight, {m.x - along * way.d.x, m.y - along * way.d.y, m.z - along * way.d.z});
  });
  parts.storeTo(sums);
}

inline void addPulls(const Dipoles& from, const float* at, float r2, Sums& sums) {
  Parts parts;
  forRegisters(from, [&](std::size_t i, std::size_t r) SEGORIENT_INLINED {
    const Way way(from, i, at, r2);
    parts.add(r, -1.F * load(from.mx + i) * way.inverse * squareRoot(way.inverse), way.d);
  });
  parts.storeTo(sums);
}
