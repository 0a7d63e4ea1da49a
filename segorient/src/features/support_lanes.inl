// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// How much of a neighbourhood lies on each of several planes, one a lane, for one instruction set;
// see lanes.inl.

#include "common/lanes.inl"

inline void supportPlanes(const SupportedPlanes& of, float* support) {
  for (std::size_t at = 0; at < of.count; at += kWidth) {
    const Lanes3 n = scaled(Lanes3{load(&of.x[at]), load(&of.y[at]), load(&of.z[at])},
                            all(of.inverse_tolerance));
    Lanes sum{};
    for (std::size_t j = 0; j < kSheetNeighbors; ++j) {
      const Lanes t = of.offset_x[j] * n.x + of.offset_y[j] * n.y + of.offset_z[j] * n.z;
      sum = sum + of.weight[j] * larger(1.F - t * t, Lanes{});
    }
    store(&support[at], sum);
  }
}
