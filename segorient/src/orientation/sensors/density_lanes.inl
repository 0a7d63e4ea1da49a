// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What a place leaves on the pieces of a surface, for one instruction set; see lanes.inl.

#include "common/lanes.inl"

/// Sets out[i] to of(at), kWidth rows at a time, where at(column) are the rows' entries in a
/// column; after the last row these are 0.
template <typename Of>
inline void setEach(std::size_t count, float* out, Of&& of) {
  for (std::size_t i = 0; i < count; i += kWidth) {
    const std::size_t left = count - i;
    const Lanes result = of([i, left](const float* column) SEGORIENT_INLINED {
      if (left >= kWidth) return load(column + i);
      float some[kWidth] = {};
      for (std::size_t l = 0; l < left; ++l) some[l] = column[i + l];
      return load(some);
    });
    if (left >= kWidth) {
      store(out + i, result);
    } else {
      for (std::size_t l = 0; l < left; ++l) out[i + l] = result[l];
    }
  }
}

template <SamplingLaw law>
inline void leave(const Sight& from, float* out) {
  setEach(from.count, out, [&](auto&& at) SEGORIENT_INLINED {
    const Lanes3 v{from.at[0] - at(from.x), from.at[1] - at(from.y), from.at[2] - at(from.z)};
    const Lanes d2 = larger(dot(v, v), all(1e-12F));
    const Lanes d = squareRoot(d2);
    const Lanes3 normal{at(from.nx), at(from.ny), at(from.nz)};
    const Lanes facing = larger(absolute(dot(v, normal)), kGrazing * d);  // times d
    if constexpr (law == SamplingLaw::SOLID_ANGLE) {
      return larger(facing / (d * d2), all(kNothing));
    } else {
      const Lanes height = v.x * from.axis[0] + v.y * from.axis[1] + v.z * from.axis[2];
      if constexpr (law == SamplingLaw::ANGLE_GRID) {
        const Lanes level = squareRoot(larger(d2 - height * height, kPole * d2));
        const Lanes above = larger(
            smaller((-1.F * height - from.lowest * d) / (kFade * d) + 0.5F, all(1.F)), all(0.F));
        return larger(above * facing / (d2 * level), all(kNothing));
      } else {
        const Lanes depth = larger(-1.F * height, kWidest * d);
        return larger(facing / (depth * depth * depth), all(kNothing));
      }
    }
  });
}

/// Natural logarithms to 1e-5, in place: of the mantissa a polynomial (Chebyshev nodes on 1 to 2).
inline void logs(float* values, std::size_t count) {
  setEach(count, values, [&](auto&& at) SEGORIENT_INLINED {
    const Mask bits = SEGORIENT_BITS_AS(Mask, larger(at(values), all(kNothing)));
    const Lanes exponent = SEGORIENT_CONVERTED((bits >> 23) - 127, Lanes);
    const Lanes m = SEGORIENT_BITS_AS(Lanes, (bits & 0x007fffff) | 0x3f800000);
    return 0.693147181F * exponent +
           (-1.93675974F +
            m * (3.5140873F +
                 m * (-2.44002976F + m * (1.11609003F + m * (-0.283826848F + m * 0.0304490045F)))));
  });
}
