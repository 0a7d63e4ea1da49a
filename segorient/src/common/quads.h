// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <cstddef>
#include <cstring>

#include "common/vectors.h"

namespace segorient {

/// Four numbers side by side.
using Quad = SEGORIENT_VECTOR(float, 4);

SEGORIENT_INLINE Quad loadQuad(const float* from) {
  Quad q;
  copyBytes(&q, from, sizeof q);
  return q;
}

/// A point's coordinates; what comes fourth is of no use, but has to be there: rows of four and
/// more are those of whole points.
SEGORIENT_INLINE Quad loadPoint(const PointView& points, std::size_t i) {
  const float* const p = points[i];
  return points.stride >= 4 ? loadQuad(p) : Quad{p[0], p[1], p[2], 0.F};
}

/// Four rows become four columns.
SEGORIENT_INLINE void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad low_ab = SEGORIENT_SHUFFLED(a, b, 0, 4, 1, 5);
  const Quad low_cd = SEGORIENT_SHUFFLED(c, d, 0, 4, 1, 5);
  const Quad high_ab = SEGORIENT_SHUFFLED(a, b, 2, 6, 3, 7);
  const Quad high_cd = SEGORIENT_SHUFFLED(c, d, 2, 6, 3, 7);
  a = SEGORIENT_SHUFFLED(low_ab, low_cd, 0, 1, 4, 5);
  b = SEGORIENT_SHUFFLED(low_ab, low_cd, 2, 3, 6, 7);
  c = SEGORIENT_SHUFFLED(high_ab, high_cd, 0, 1, 4, 5);
  d = SEGORIENT_SHUFFLED(high_ab, high_cd, 2, 3, 6, 7);
}

}  // namespace segorient
