// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "common/dot.h"

namespace segorient {

/// How far two normals agree, -1 to 1, if one of them is mirrored at the plane between their two
/// places, as a surface carries it on from one to the other: n . m - 2 (n . d)(m . d) / |d|^2,
/// right across bends and sharp edges too (Konig and Gumhold 2009; Xie et al. 2003). \param chord
/// d, from one place to the other \param square |d|^2, above 0; more means that the
///        chord has no clear direction
inline float mirroredAgreement(const float* n, const float* m, const float* chord, float square) {
  return dot(n, m) - 2.F * dot(n, chord) * (dot(m, chord) / square);
}

}  // namespace segorient
